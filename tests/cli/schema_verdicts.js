// SPDX-License-Identifier: Apache-2.0
//
// node schema_verdicts.js SCHEMA GRAPHS: what ajv says of each graph of a JSON array, a line each:
// "ok", or its first errors.
const fs = require("fs");
const Ajv = require("ajv");

const [schema, graphs] = process.argv.slice(2).map((file) => JSON.parse(fs.readFileSync(file)));
// Not strict: "enumDescriptions" and "allowComments" are words that editors understand.
const validate = new Ajv({ strict: false }).compile(schema);
for (const graph of graphs) {
  const errors = validate(graph) ? [] : validate.errors;
  console.log(errors.map((e) => `${e.instancePath} ${e.message}`).slice(0, 4).join("; ") || "ok");
}
