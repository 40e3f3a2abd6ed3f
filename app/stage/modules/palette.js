// Colours of the wall. They are the same in the light and the dark theme: the stage doesn't change.

export const WALL = {
  top: '#3B4953',
  bottom: '#323F48',
  seam: 'rgba(255,255,255,.045)',
  lane: '#27323A',
  laneEdge: 'rgba(255,255,255,.10)',
  chevron: 'rgba(255,255,255,.20)',
  start: 'rgba(255,255,255,.85)',
  label: 'rgba(255,255,255,.72)',
  halo: 'rgba(18,26,31,.78)',
  hand: '#FFFFFF',
};

export const PAINT = [246, 232, 200];

export const TILT = { straight: '#8FD14F', little: '#FFB224', too: '#FF6B5E', idle: '#C9D3D8' };

export const CANVAS_FONT = '"Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';
