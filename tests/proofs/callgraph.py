"""The compiler's own call graph (gcc -fcallgraph-info=su,da): who calls whom, with how much stack."""
import re

NODE = re.compile(r'node: \{ title: "([^"]+)" label: "([^"]*)"( shape : ellipse)? \}')
EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
STACK = re.compile(r"(\d+) bytes \(([a-z,]+)\)")
INDIRECT = "__indirect_call"


class CallGraph:
    """Functions of several objects together; those of static linkage carry their file in the title."""

    def __init__(self, files):
        self.stack = {}  # of each function that has a body here: bytes
        self.source = {}  # of each such function: its file
        self.unbounded = set()  # functions whose frame has no fixed size
        self.calls = {}
        for path in files:
            self._read(path.read_text(encoding="utf-8"))

    def _read(self, text):
        for title, label, elsewhere in NODE.findall(text):
            found = STACK.search(label)
            if not elsewhere and found:
                self.stack[title] = int(found.group(1))
                self.source[title] = label.split("\\n")[1].split(":")[0]
                if found.group(2) == "dynamic":
                    self.unbounded.add(title)
        for caller, callee in EDGE.findall(text):
            self.calls.setdefault(caller, set()).add(callee)

    def join(self, caller, callee):
        """What an indirect call of one function is known to reach."""
        self.calls[caller] = (self.calls[caller] - {INDIRECT}) | {callee}

    def reached(self, root):
        """All that a call of root can reach, itself included."""
        seen, waiting = set(), [root]
        while waiting:
            title = waiting.pop()
            if title not in seen:
                seen.add(title)
                waiting += self.calls.get(title, ())
        return seen

    def leaves(self, root):
        """(caller, callee) for every call out of what has a body here."""
        reached = self.reached(root)
        return {(caller, callee) for caller in reached if caller in self.stack
                for callee in self.calls.get(caller, ()) if callee not in self.stack}

    def cycle(self, root):
        """A way from a function back to itself, or nothing."""
        done, way = set(), []

        def visit(title):
            if title in way:
                return way[way.index(title):] + [title]
            if title in done:
                return None
            way.append(title)
            for callee in sorted(self.calls.get(title, ())):
                found = visit(callee)
                if found:
                    return found
            way.pop()
            done.add(title)
            return None

        return visit(root)

    def deepest(self, root, leaf_bytes):
        """Bytes of stack below a call of root, and the way there; without cycles. leaf_bytes: of what has no body here."""
        known = {}

        def visit(title):
            if title not in known:
                below = max((visit(callee) for callee in self.calls.get(title, ())), default=(0, []))
                known[title] = (self.stack.get(title, leaf_bytes) + below[0], [title] + below[1])
            return known[title]

        return visit(root)
