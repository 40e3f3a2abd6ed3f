// Answers not yet submitted: kept in this tab, so that going back or a reload loses none.

export class Draft {
  constructor(key) {
    this.key = `elbowroom.draft.${key}`;
    this.answers = {};
    try {
      this.answers = JSON.parse(sessionStorage.getItem(this.key)) ?? {};
    } catch {
      // Storage may be blocked or hold something else: then the draft lives as long as the page.
    }
  }

  set(question, answer) {
    this.answers[question] = answer;
    try {
      sessionStorage.setItem(this.key, JSON.stringify(this.answers));
    } catch {
      // As above.
    }
  }

  forget() {
    try {
      sessionStorage.removeItem(this.key);
    } catch {
      // As above.
    }
  }
}
