"""A client of Foxglove's WebSocket protocol that is not Foxglove: subscribes, publishes, calls services.

    client = FoxgloveClient("ws://127.0.0.1:8765")
    client.subscribe("/scan")
    data = client.wait_for("/scan")                         # the newest message's bytes
    client.publish("/cmd_vel", "geometry_msgs/Twist", {...})
    client.call("/ale/command", {"words": "stop"})
"""
import json
import struct
import time

from web_socket import WebSocket


class FoxgloveClient:
    def __init__(self, url, **how):
        self.socket = WebSocket(url, protocol="foxglove.sdk.v1", **how)
        self.channels, self.services, self.subscribed, self.newest = {}, {}, {}, {}
        self.published, self.calls, self.answers, self.info = {}, 0, {}, None

    def _take(self):
        is_text, data = self.socket.next_bytes()
        if not is_text:
            return self._take_binary(data)
        message = json.loads(data)
        if message["op"] == "serverInfo":
            self.info = message
        elif message["op"] == "advertise":
            self.channels |= {each["topic"]: each for each in message["channels"]}
        elif message["op"] == "advertiseServices":
            self.services |= {each["name"]: each["id"] for each in message["services"]}
        elif message["op"] == "serviceCallFailure":
            self.answers[message["callId"]] = message
        return None

    def _take_binary(self, data):
        if data[0] == 1:
            number, = struct.unpack_from("<I", data, 1)
            self.newest[self.subscribed[number]] = data[13:]
        elif data[0] == 3:
            _, call, length = struct.unpack_from("<III", data, 1)
            self.answers[call] = json.loads(data[13 + length:])

    def wait(self, condition, what, seconds=120):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, what
            self._take()

    def subscribe(self, topic):
        self.wait(lambda: topic in self.channels, f"{topic} is not advertised")
        number = len(self.subscribed)
        self.subscribed[number] = topic
        self.socket.send(json.dumps({"op": "subscribe", "subscriptions": [{"id": number, "channelId": self.channels[topic]["id"]}]}))

    def wait_for(self, topic):
        self.newest.pop(topic, None)
        self.wait(lambda: topic in self.newest, f"nothing on {topic}")
        return self.newest[topic]

    def publish(self, topic, schema, message, encoding="json"):
        if topic not in self.published:
            self.published[topic] = len(self.published) + 1
            self.socket.send(json.dumps({"op": "advertise", "channels": [
                {"id": self.published[topic], "topic": topic, "encoding": encoding, "schemaName": schema}]}))
        data = message if isinstance(message, bytes) else json.dumps(message).encode()
        self.socket.send_bytes(struct.pack("<BI", 1, self.published[topic]) + data)

    def call(self, service, request):
        self.wait(lambda: service in self.services, f"{service} is not advertised")
        self.calls += 1
        data = request if isinstance(request, bytes) else json.dumps(request).encode()
        self.socket.send_bytes(struct.pack("<BIII", 2, self.services[service], self.calls, 4) + b"json" + data)
        self.wait(lambda: self.calls in self.answers, f"{service} does not answer")
        return self.answers[self.calls]

    def close(self):
        self.socket.close()
