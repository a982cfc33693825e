// Runs the Khronos validator over glTF files: node validate.mjs FILE...
// Prints what it finds. Fails if a file has errors, or warnings other than of an extension that the validator does not know.
import {readFile} from 'node:fs/promises';
import {dirname, join} from 'node:path';
import process from 'node:process';
import validator from 'gltf-validator';

const kAllowedWarnings = new Set(['UNSUPPORTED_EXTENSION']);

async function validate(path) {
    const report = await validator.validateBytes(new Uint8Array(await readFile(path)), {
        uri: path,
        maxIssues: 100,
        externalResourceFunction: async uri => new Uint8Array(await readFile(join(dirname(path), decodeURIComponent(uri)))),
    });
    const bad = report.issues.messages.filter(
        m => m.severity === 0 || (m.severity === 1 && !kAllowedWarnings.has(m.code)));
    for (const m of bad) console.log(`${path}: ${m.code} at ${m.pointer}: ${m.message}`);
    console.log(`${path}: ${report.issues.numErrors} errors, ${report.issues.numWarnings} warnings`);
    return bad.length === 0;
}

let fine = process.argv.length > 2;
for (const path of process.argv.slice(2)) fine = (await validate(path)) && fine;
process.exit(fine ? 0 : 1);
