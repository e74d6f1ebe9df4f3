// SPDX-License-Identifier: GPL-3.0-or-later
// Light or dark: as the system says until somebody chooses.

type Theme = 'light' | 'dark';
const KEY = 'vdbmap-theme';
const system = window.matchMedia('(prefers-color-scheme: dark)');

function stored(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null; // storage may be forbidden
  }
}

export function currentTheme(): Theme {
  const theme = document.documentElement.dataset.theme;
  return theme === 'light' || theme === 'dark' ? theme : system.matches ? 'dark' : 'light';
}

export function startTheme(onChange: () => void): void {
  const theme = stored();
  if (theme === 'light' || theme === 'dark') document.documentElement.dataset.theme = theme;
  system.addEventListener('change', onChange);
}

export function toggleTheme(): Theme {
  const theme = currentTheme() === 'dark' ? 'light' : 'dark';
  document.documentElement.dataset.theme = theme;
  try {
    localStorage.setItem(KEY, theme);
  } catch {
    // then it lasts as long as the page
  }
  return theme;
}

/** Colours of the picture's background, from the style sheet. */
export function skyColours(): { low: string; high: string } {
  const style = getComputedStyle(document.documentElement);
  return { low: style.getPropertyValue('--sky-low').trim(), high: style.getPropertyValue('--sky-high').trim() };
}
