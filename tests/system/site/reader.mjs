// Reads people of a hall with the client of the NATS project itself: node reader.mjs PORT PASSWORD SUBJECT COUNT
// Prints each message as a line of JSON: {"subject": ..., "message": ...}.
import { connect } from 'nats';

const [port, password, subject, count] = process.argv.slice(2);
const client = await connect({ servers: `127.0.0.1:${port}`, user: 'reader', pass: password });
const subscription = client.subscribe(subject, { max: Number(count) });
for await (const message of subscription)
  console.log(JSON.stringify({ subject: message.subject, message: JSON.parse(new TextDecoder().decode(message.data)) }));
await client.close();
