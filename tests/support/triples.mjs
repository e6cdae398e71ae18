// Compares graphs.
const RDF = 'http://www.w3.org/1999/02/22-rdf-syntax-ns#';

/// Triples as text that can be compared.  The only blank nodes of our documents are the cells of lists, which stand where their list does.
export function lines(quads) {
  const cell = (name) => new Map(quads.filter((q) => q.predicate.value === RDF + name).map((q) => [q.subject.value, q.object]));
  const [first, rest] = [cell('first'), cell('rest')];
  const text = (term) => {
    if (term.termType === 'Literal') return `"${term.value}"^^${term.datatype.value}`;
    if (term.termType !== 'BlankNode') return term.value;
    const items = [];
    for (let at = term; at.value !== `${RDF}nil`; at = rest.get(at.value)) items.push(text(first.get(at.value)));
    return `( ${items.join(' ')} )`;
  };
  return quads.filter((q) => q.subject.termType !== 'BlankNode')
    .map((q) => [q.subject, q.predicate, q.object].map(text).join(' ')).sort();
}
