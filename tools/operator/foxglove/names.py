"""Names of topics and frames: those of one robot among several stand in its namespace.

    names = Names("rover1")
    names.topic("/scan")             # /rover1/scan
    names.frame("map")               # rover1/map
    names.plain("/rover1/cmd_vel")   # /cmd_vel; None: of somebody else
"""
import re


class Names:
    def __init__(self, space=""):
        """space: empty, or letters, digits, _, and / between them; ValueError when not."""
        if space and not re.fullmatch(r"\w+(/\w+)*", space, re.ASCII):
            raise ValueError(f"{space}: letters, digits, _, and / between them")
        self.space = space

    def topic(self, name):
        return f"/{self.space}{name}" if self.space else name

    def frame(self, name):
        return f"{self.space}/{name}" if self.space else name

    def plain(self, topic):
        start = self.topic("")
        return topic[len(start):] if topic.startswith(f"{start}/") else None
