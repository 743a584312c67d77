/**
 * The types of the HTTP interface in TypeScript, made from its description (OpenAPI).
 *
 *   npm run types      writes src/api/types.ts
 *
 * The description is that of the program (WINDFALL); what each type and key means stands
 * there. Knows the keywords that it uses, and refuses others.
 */

import { writeFile } from "node:fs/promises";
import { pathToFileURL } from "node:url";
import { scratch, serve } from "./tests/helpers.mjs";

export const FILE = new URL("src/api/types.ts", import.meta.url);

const KNOWN = new Set(
  `$ref type format description properties required additionalProperties propertyNames items
   prefixItems minItems maxItems minimum enum oneOf allOf default example`.split(/\s+/),
);

/** Columns of a line of the file. */
const WIDTH = 120;

/** Asks the program for the description of its interface. */
async function description() {
  const { directory, remove } = await scratch();
  const server = await serve(directory);
  try {
    const address = `${server.origin}/api/openapi.json`;
    return await (await fetch(address, { headers: server.admitted })).json();
  } finally {
    await server.stop();
    await remove();
  }
}

/** Schemas of the description by their names. */
let schemas = {};

const isMap = (schema) => schema?.type === "object" && schema.additionalProperties?.constructor === Object;
const union = (parts) => [...new Set(parts)].join(" | ");
const grouped = (text) => (/[|&]/.test(text) ? `(${text})` : text);

/** A schema as a type. */
function typeOf(schema, indent) {
  const foreign = Object.keys(schema).filter((key) => !KNOWN.has(key));
  if (foreign.length > 0) throw new Error(`unknown keywords ${foreign}: ${JSON.stringify(schema)}`);
  if (schema.$ref) {
    const name = schema.$ref.replace("#/components/schemas/", "");
    if (!(name in schemas)) throw new Error(`no schema ${name}`);
    return isMap(schemas[name]) ? typeOf(schemas[name], indent) : name;
  }
  if (schema.oneOf) return union(schema.oneOf.map((part) => typeOf(part, indent)));
  if (schema.allOf) return schema.allOf.map((part) => grouped(typeOf(part, indent))).join(" & ");
  if (schema.enum) return union(schema.enum.map((value) => JSON.stringify(value)));
  if (Array.isArray(schema.type)) return union(schema.type.map((type) => typeOf({ ...schema, type }, indent)));
  switch (schema.type) {
    case "integer":
      return "number";
    case "number":
    case "string":
    case "boolean":
    case "null":
      return schema.type;
    case "array":
      if (schema.prefixItems) return `[${schema.prefixItems.map((item) => typeOf(item, indent)).join(", ")}]`;
      return `${grouped(typeOf(schema.items, indent))}[]`;
    case "object":
      return isMap(schema)
        ? `Record<string, ${typeOf(schema.additionalProperties, indent)}>`
        : objectOf(schema, indent);
    default:
      throw new Error(`unknown type: ${JSON.stringify(schema)}`);
  }
}

/** Keys on as few lines as possible: nobody reads the file line by line. */
function objectOf({ properties = {}, required = [] }, indent) {
  const inner = `${indent}  `;
  const lines = [];
  for (const [key, schema] of Object.entries(properties)) {
    const entry = `${key}${required.includes(key) ? "" : "?"}: ${typeOf(schema, inner)};`;
    const last = lines.at(-1);
    if (last !== undefined && last.length + entry.length < WIDTH) lines[lines.length - 1] = `${last} ${entry}`;
    else lines.push(`${inner}${entry}`);
  }
  if (lines.length === 1 && lines[0].length + indent.length < WIDTH - 40) return `{ ${lines[0].trim()} }`;
  return `{\n${lines.join("\n")}\n${indent}}`;
}

/** A request with what it answers, sends and asks. */
function call({ parameters = [], requestBody, responses }) {
  const content = (of) => Object.entries(of?.content ?? {})[0];
  const of = (found, bytes) => {
    if (!found) return "undefined";
    const [kind, { schema }] = found;
    if (kind === "application/json") return typeOf(schema, "  ");
    return kind === "application/octet-stream" ? bytes : "string";
  };
  const asked = parameters.filter((own) => own.in === "query");
  const query = asked.map((own) => `${own.name}${own.required ? "" : "?"}: ${typeOf(own.schema, "")}`);
  const answer = Object.entries(responses).find(([status]) => status.startsWith("2"))[1];
  const parts = [
    of(content(answer), "ArrayBuffer"),
    of(content(requestBody), "Blob"),
    query.length > 0 ? `{ ${query.join("; ")} }` : "undefined",
  ];
  while (parts.at(-1) === "undefined") parts.pop();
  return `Call<${parts.join(", ")}>`;
}

/** The text of src/api/types.ts. */
export async function types() {
  const { components, paths } = await description();
  schemas = components.schemas;
  const named = Object.entries(schemas).map(([name, schema]) => {
    if (isMap(schema)) return "";
    const text = typeOf(schema, "");
    const start = schema.type === "object" ? `interface ${name} ` : `type ${name} = `;
    return `export ${start}${text}${schema.type === "object" ? "" : ";"}\n`;
  });
  const calls = Object.entries(paths).flatMap(([path, methods]) =>
    Object.entries(methods).map(([method, own]) => `  "${method.toUpperCase()} ${path}": ${call(own)};\n`),
  );
  return `// Made by \`npm run types\` from the description of the interface; not to be edited.

${named.join("")}
/** A request with what it answers, what it sends, and its parameters behind "?". */
export interface Call<Answer, Body = undefined, Query = undefined> {
  answer: Answer;
  body: Body;
  query: Query;
}

/** All requests by method and address. */
export interface Calls {
${calls.join("")}}
`;
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) await writeFile(FILE, await types());
