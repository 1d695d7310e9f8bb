// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
import { fillReport, metres, summary } from './report.js';
export { metres, summary };
export function fillPanel({ sections }, data) {
  data.profile = data.profiles[0]?.points.map(([d, z]) => [d, z]) ?? [];
  fillReport(sections, data);
  return { hover() {} };
}
