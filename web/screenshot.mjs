// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// node screenshot.mjs PAGE OUT.png|jpg [map] [dark] [phone]: what a reader of a report page sees first.
import path from 'node:path';
import { launch, open } from '../tests/page/browser.mjs';

const [file, out, ...ways] = process.argv.slice(2);
const browser = await launch('webgl');
const { page, complaints } = await open(browser, path.resolve(file), {
  query: '?seg=1023', colorScheme: ways.includes('dark') ? 'dark' : 'light',
  viewport: ways.includes('phone') ? { width: 390, height: 844 } : { width: 1400, height: 900 },
});
if (ways.includes('map')) await page.click('#bmap');
await page.mouse.move(0, 0);
await page.evaluate(() => window.__thalweg.still());
await page.screenshot({ path: out, ...(out.endsWith('.jpg') ? { type: 'jpeg', quality: 82 } : {}) });
await browser.close();
if (complaints.length) throw new Error(complaints.join('\n'));
