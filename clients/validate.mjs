// Usage: node validate.mjs FILE...
// Prints one line of JSON: for each file, how often the Khronos validator names each error code.
import { readFile } from 'node:fs/promises';
import { basename, dirname, join } from 'node:path';
import validator from 'gltf-validator';

const SEVERITY_ERROR = 0;

async function errorsOf(path) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(path)), {
    uri: basename(path),
    maxIssues: 0,
    externalResourceFunction: async (uri) =>
      new Uint8Array(await readFile(join(dirname(path), decodeURIComponent(uri)))),
  });
  const errors = {};
  for (const message of report.issues.messages) {
    if (message.severity === SEVERITY_ERROR) {
      errors[message.code] = (errors[message.code] ?? 0) + 1;
    }
  }
  return { errors, animations: report.info?.animationCount ?? 0 };
}

console.log(JSON.stringify(await Promise.all(process.argv.slice(2).map(errorsOf))));
