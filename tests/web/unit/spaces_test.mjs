// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { readSite } from '../../../tools/web/src/data/site.ts';
import { areElsewhere, count, directionOfRow, isNew, matches, readSpaces, stateAt, turnover } from '../../../tools/web/src/data/spaces.ts';

const EPOCHS = ['1', '2', '3'];

function space(id, states, x = 0, y = 0) {
  const polygon = [[x, y, 0], [x + 5, y, 0], [x + 5, y + 2, 0], [x, y + 2, 0]];
  return { id, polygon, height: 1.6, states: states.map((state, i) => ({ epoch: EPOCHS[i], state })) };
}
const read = (...spaces) => readSpaces({ epochs: EPOCHS, spaces });

describe('Spaces', () => {
  it('are unknown where an epoch says nothing, or something odd', () => {
    const [a] = read(space('a', ['occupied', 'taken']));
    expect(EPOCHS.map((epoch) => stateAt(a, epoch))).toEqual(['occupied', 'unknown', 'unknown']);
  });

  it('are new only between two known states', () => {
    const [a, b] = read(space('a', ['occupied', 'vacant', 'vacant']), space('b', ['unknown', 'vacant', 'unknown']));
    expect(EPOCHS.map((epoch) => isNew(a, epoch, EPOCHS))).toEqual([false, true, false]);
    expect(EPOCHS.map((epoch) => isNew(b, epoch, EPOCHS))).toEqual([false, false, false]);
  });

  it('are counted as they are listed', () => {
    const spaces = read(space('a', ['occupied', 'vacant']), space('b', ['occupied', 'occupied']), space('c', ['vacant', 'unknown']));
    const counts = (epoch) => ['all', 'occupied', 'vacant', 'unknown', 'changed'].map((filter) => count(spaces, filter, epoch, EPOCHS));
    expect(counts('1')).toEqual([3, 2, 1, 0, 0]);
    expect(counts('2')).toEqual([3, 1, 1, 1, 1]);
    expect(spaces.filter((s) => matches(s, 'changed', '2', EPOCHS)).map(({ id }) => id)).toEqual(['a']);
  });

  it('turn over as often as known states differ, gaps passed over', () => {
    const [a] = read(space('a', ['occupied', 'unknown', 'vacant']));
    expect(turnover(a, EPOCHS)).toEqual({ changes: 1, known: 2 });
  });

  it('of another place are recognized, those at the edge kept', () => {
    const site = readSite({ format: 'vdbmap-site', version: 1, epochs: [], bounds: { min: [0, 0, 0], max: [100, 20, 5] } });
    expect(areElsewhere(read(space('a', [], 130, 0)), site)).toBe(false);
    expect(areElsewhere(read(space('a', [], 5000, 0), space('b', [], 0, -300)), site)).toBe(true);
    expect(areElsewhere([], site)).toBe(false);
  });

  it('stand in a row whose direction does not depend on theirs', () => {
    const bays = [0, 1, 2, 3].map((i) => ({ ...space(`${i}`, []), polygon: [[0, 3 * i, 0], [5, 3 * i, 0], [5, 3 * i + 2, 0], [0, 3 * i + 2, 0]] }));
    expect(Math.abs(Math.cos(directionOfRow(read(...bays)[0], read(...bays))))).toBeLessThan(1e-9);
    const [alone] = read(space('a', []));
    expect(Math.abs(Math.sin(directionOfRow(alone, [alone])))).toBeLessThan(1e-9);
  });

  it('cannot be read from anything', () => {
    expect(() => readSpaces({})).toThrow('spaces.json: no list of spaces');
    expect(() => read({ id: 'a', polygon: [[0, 0, 0], [1, 0, 0]] })).toThrow('space a has no polygon of three corners');
    expect(() => read({ id: 'a', polygon: [[0, 0], [1, 0], [1, 1]] })).toThrow('space a has no polygon');
  });
});
