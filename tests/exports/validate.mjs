// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// validate.mjs FILE ...: the reports of Khronos' glTF validator, as one line of JSON.
import { readFileSync } from 'node:fs'
import validator from 'gltf-validator'

const reports = {}
for (const path of process.argv.slice(2)) {
  try {
    reports[path] = (await validator.validateBytes(new Uint8Array(readFileSync(path)), { maxIssues: 100 })).issues
  } catch (error) { // not a GLB at all
    reports[path] = { numErrors: 1, numWarnings: 0, messages: [{ code: 'UNREADABLE', message: String(error), severity: 0 }] }
  }
}
console.log(JSON.stringify(reports))
