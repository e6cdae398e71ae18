// Does a Turtle document conform to proto/shapes.ttl?  usage: conforms.mjs BASE CLASS < document; says what does not, and how many nodes
// of the class there are.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import { DataFactory, Parser, Store } from 'n3';
import Validator from 'rdf-validate-shacl';

const [base, name] = process.argv.slice(2);
const parsed = (text, baseIRI) => new Store(new Parser({ baseIRI }).parse(text));
const shapes = fileURLToPath(new URL('../../proto/shapes.ttl', import.meta.url));
const document = parsed(readFileSync(0, 'utf8'), base);
const type = DataFactory.namedNode('http://www.w3.org/1999/02/22-rdf-syntax-ns#type');
const all = document.getSubjects(type, DataFactory.namedNode(`https://w3id.org/chorus-tracking/ns#${name}`), null);
const report = await new Validator(parsed(readFileSync(shapes, 'utf8'), 'http://localhost/')).validate(document);
console.log(`${all.length} ${name}`);
for (const { path, message } of report.results) console.log('wrong:', path?.value, message?.map((one) => one.value).join('; '));
process.exit(report.conforms && all.length > 0 ? 0 : 1);
