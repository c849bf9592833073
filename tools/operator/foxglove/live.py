"""The live bridge: LCM in, a WebSocket server that Foxglove opens, commands back."""
import contextlib
import json
import queue
import signal
import sys
import threading

import foxglove
from foxglove import websocket

from . import bus as lcm_bus
from . import orders, scene
from .cells import Cells
from .names import Names
from .near import program
from .recording import Recording

SCHEMA = {"type": "object", "title": "ale.command", "properties": {"words": {"type": "string"}}}
ANSWER = {"type": "object", "title": "ale.answer", "properties": {"obeyed": {"type": "boolean"}, "words": {"type": "string"}}}
DRIVES_A_SECOND = 20
SECONDS_A_GRID = 2
ONLY_RECORDED = ["ALE_ODOMETRY_EXACT", "ALE_SPEAKER"]


def say(text):
    print(f"ale-foxglove: {text}", file=sys.stderr, flush=True)


class Desk:
    """What clients publish, one after the other; of set points only the newest, since older ones are of no use."""

    def __init__(self, given, names):
        self.given = given  # Orders
        self.names = names
        self.waiting = queue.Queue(16)
        self.drive = None
        self.told = {}
        self.counts = {"obeyed": 0, "refused": 0}
        threading.Thread(target=self._work, daemon=True).start()

    def take(self, topic, data):
        try:
            line = orders.command_of(self.names.plain(topic), data, self.names.frame("map"))
        except orders.Refused as refusal:
            self.tell(topic, False, str(refusal))
            return
        if line.startswith("drive "):
            self.drive = line
        else:
            try:
                self.waiting.put_nowait((topic, line))
            except queue.Full:
                self.tell(topic, False, "too many commands at once")

    def _work(self):
        while True:
            try:
                topic, line = self.waiting.get(timeout=1 / DRIVES_A_SECOND)
            except queue.Empty:
                topic, line, self.drive = self.names.topic("/cmd_vel"), self.drive, None
            if line:
                self.tell(topic, *self.given.give(line))

    def tell(self, topic, obeyed, words):
        """Each answer once in a row."""
        self.counts["obeyed" if obeyed else "refused"] += 1
        if self.told.get(topic) != (obeyed, words):
            self.told[topic] = (obeyed, words)
            say(f"{topic}: {'' if obeyed else 'refused: '}{words}")


class Listener(websocket.ServerListener):
    def __init__(self, desk):
        self.desk = desk
        self.topics = {}

    def _is_order(self, topic):
        return self.desk.names.plain(topic) in orders.TOPICS

    def on_client_advertise(self, client, channel):
        if self._is_order(channel.topic) and channel.encoding != "json":
            self.desk.tell(channel.topic, False, f"only JSON is understood, not {channel.encoding}")
        self.topics[client.id, channel.id] = (channel.topic, channel.encoding)

    def on_client_unadvertise(self, client, client_channel_id):
        self.topics.pop((client.id, client_channel_id), None)

    def on_message_data(self, client, client_channel_id, data):
        topic, encoding = self.topics.get((client.id, client_channel_id), ("", ""))
        if self._is_order(topic) and encoding == "json":
            self.desk.take(topic, data)


def service(given, names):
    """/ale/command: any verb that the robot knows, as ale-send takes it."""
    def handle(request):
        try:
            words = json.loads(request.payload)["words"]
            obeyed, answer = given.give(words) if isinstance(words, str) else (False, '"words" is a text')
        except (ValueError, KeyError, TypeError):
            obeyed, answer = False, 'not {"words": "explore on"}'
        return json.dumps({"obeyed": obeyed, "words": answer}).encode()

    def described(schema):
        return foxglove.MessageSchema(encoding="json", schema=foxglove.Schema(
            name=schema["title"], encoding="jsonschema", data=json.dumps(schema).encode()))
    return foxglove.Service(names.topic("/ale/command"), schema=foxglove.ServiceSchema("ale.command", request=described(SCHEMA),
                                                                          response=described(ANSWER)), handler=handle)


def orders_of(options):
    if not options.keys:
        return orders.Orders(None)
    command = [program("ale-send"), "--keys", options.keys]
    for name in ("robots", "robot", "lcm_url"):
        if getattr(options, name):
            command += [f"--{name.replace('_', '-')}", getattr(options, name)]
    return orders.Orders(command)


def run(options):
    foxglove.set_log_level("WARN")
    context = foxglove.Context()
    names = Names(options.namespace)
    shown = scene.Scene(context, names)
    heard = lcm_bus.Bus(options.lcm_url, [*shown.takers, *(ONLY_RECORDED if options.record else [])])
    given = orders_of(options)
    desk = Desk(given, names)
    server = foxglove.start_server(
        name="ALE-SLAM", host=options.host, port=options.port, context=context, server_listener=Listener(desk),
        capabilities=[websocket.Capability.ClientPublish, websocket.Capability.Services], supported_encodings=["json"],
        services=[service(given, names)], message_backlog_size=256)
    recording = Recording(options.record, context) if options.record else contextlib.nullcontext()
    cells = Cells(context, names, SECONDS_A_GRID)
    stopping = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stopping.set())
    print(f"ws://{options.host}:{server.port}", flush=True)
    try:
        with recording as record, cells:
            while not stopping.is_set():
                for channel, data in heard.receive(0.2):
                    shown.take(channel, data)
                    cells.take(channel, data)
                    if record:
                        record.take(channel, data)
    finally:
        server.stop()
        given.close()
        say(f"{shown.malformed} messages of the robot were malformed; commands: {desk.counts['obeyed']} obeyed, "
            f"{desk.counts['refused']} refused")
    return 0
