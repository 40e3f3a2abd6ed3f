// A radio group of native inputs laid over what they choose: arrows move, Tab leaves, a screen reader reads the label.

import { el } from './elements.js';

let groups = 0;

// options: [{ value, label, content: nodes, classes }]; onChoose(value) is called for every choice by hand,
// also of what is chosen already.
export function radioGroup(container, { labelledBy, label, options, chosen, onChoose }) {
  container.setAttribute('role', 'radiogroup');
  if (labelledBy) container.setAttribute('aria-labelledby', labelledBy);
  else container.setAttribute('aria-label', label);
  const name = `group-${++groups}`;
  const inputs = options.map((option) => {
    const input = el('input', { type: 'radio', name, value: option.value, 'aria-label': option.label });
    input.checked = option.value === chosen;
    input.addEventListener('click', () => onChoose(option.value));
    container.append(el(`div.option${option.classes ?? ''}`, {}, input, option.content));
    return input;
  });
  return {
    inputs,
    choose(value) {
      for (const input of inputs) input.checked = input.value === value;
    },
    focus() {
      (inputs.find((input) => input.checked) ?? inputs[0]).focus();
    },
  };
}
