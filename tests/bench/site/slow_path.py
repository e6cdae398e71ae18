"""A path to a server that takes its time, or lets nothing through for a while, as a network does: what was sent comes late, not never."""
import asyncio
import threading
import time


class SlowPath:
    def __init__(self, port):
        self.target, self.delay_s, self.port = port, 0.0, None
        self.loop = asyncio.new_event_loop()
        self.open = asyncio.Event()
        self.open.set()
        ready = threading.Event()
        self.thread = threading.Thread(target=self._run, args=(ready,), daemon=True)
        self.thread.start()
        ready.wait(10)

    def cut(self):
        self.loop.call_soon_threadsafe(self.open.clear)

    def heal(self):
        self.loop.call_soon_threadsafe(self.open.set)

    def close(self):
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join(10)

    def _run(self, ready):
        async def listen():
            server = await asyncio.start_server(self._relay, "127.0.0.1", 0)
            self.port = server.sockets[0].getsockname()[1]
            ready.set()

        self.loop.run_until_complete(listen())
        self.loop.run_forever()
        for task in asyncio.all_tasks(self.loop):
            task.cancel()
        self.loop.run_until_complete(asyncio.sleep(0.1))

    async def _relay(self, reader, writer):
        try:
            there = await asyncio.open_connection("127.0.0.1", self.target)
        except OSError:
            writer.close()
            return
        try:
            await asyncio.gather(self._pump(reader, there[1]), self._pump(there[0], writer))
        except asyncio.CancelledError:  # close()
            pass

    async def _pump(self, reader, writer):
        waiting = asyncio.Queue()

        async def deliver():
            while (piece := await waiting.get())[1]:
                await asyncio.sleep(max(0.0, piece[0] - time.monotonic()))
                await self.open.wait()
                writer.write(piece[1])
                await writer.drain()
            writer.close()

        delivering = asyncio.ensure_future(deliver())
        try:
            while data := await reader.read(1 << 16):
                waiting.put_nowait((time.monotonic() + self.delay_s, data))
                await self.open.wait()
        except OSError:
            pass
        waiting.put_nowait((0.0, b""))
        try:
            await delivering
        except OSError:
            pass
