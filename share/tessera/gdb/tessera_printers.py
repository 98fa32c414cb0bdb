"""Shows the values of a Tessera controller in gdb as people read them. `tessera simulate --debug` loads this file."""

import gdb
import gdb.printing


def seconds_text(nanoseconds):
    """1250000000 is "1.25 s"."""
    if abs(nanoseconds) >= 2**63 - 1:
        return "never"
    for unit, size in (("s", 1e9), ("ms", 1e6), ("us", 1e3)):
        if abs(nanoseconds) >= size:
            return f"{nanoseconds / size:g} {unit}"
    return f"{nanoseconds} ns"


def count_of(duration):
    return int(duration["__r"])


class Duration:
    """tessera::Duration, which is nanoseconds."""

    def __init__(self, value):
        self.value = value

    def to_string(self):
        return seconds_text(count_of(self.value))


class Time:
    """tessera::Time: since the start of the run."""

    def __init__(self, value):
        self.value = value

    def to_string(self):
        return seconds_text(count_of(self.value["__d"]))


class BoundedString:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        bytes_ = self.value["bytes_"]["_M_elems"]
        return bytes_.cast(gdb.lookup_type("char").array(max(0, int(self.value["size_"]) - 1))).string(
            "utf-8", "replace", int(self.value["size_"])
        )

    def display_hint(self):
        return "string"


class LargeArray:
    """The elements. `set print elements` limits how many are shown."""

    def __init__(self, value):
        self.value = value

    def elements(self):
        return self.value["block_"].dereference()["elements"]["_M_elems"]

    def to_string(self):
        return f"{self.value.type.strip_typedefs().template_argument(1)} elements"

    def children(self):
        elements = self.elements()
        first, last = elements.type.strip_typedefs().range()
        for index in range(first, last + 1):
            yield f"[{index}]", elements[index]

    def display_hint(self):
        return "array"


class Buffer:
    """An input or output: the value, and beside it its status, as in the specification."""

    def __init__(self, value):
        self.value = value
        self.bases = [field for field in value.type.strip_typedefs().fields() if field.is_base_class]

    def status(self):
        base = self.value[self.bases[-1]]
        words = []
        names = {field.name for field in base.type.fields()}
        if "age" in names:
            words.append("valid" if base["valid"] else "not valid")
            if base["fresh"]:
                words.append("fresh")
            age = count_of(base["age"])
            words.append("no value yet" if age >= 2**63 - 1 else f"{seconds_text(age)} old")
        else:
            stamp = count_of(base["stamp"]["__d"])
            words.append(f"sent at {seconds_text(stamp)}")
        words += [word.replace("_", " ") for word in ("failed", "timed_out", "disconnected")
                  if word in names and base[word]]
        return ", ".join(words)

    def to_string(self):
        return f"({self.status()})"

    def children(self):
        if len(self.bases) == 1:
            yield "value", self.value["value_"]
            return
        payload = self.value[self.bases[0]]
        fields = payload.type.strip_typedefs().fields()
        # A printer of its own shows it, for example a large array.
        if gdb.default_visualizer(payload) is not None or not fields:
            yield "value", payload
            return
        for field in fields:
            yield field.name, payload[field]


def printers():
    all_ = gdb.printing.RegexpCollectionPrettyPrinter("tessera")
    all_.add_printer("Duration", r"^std::chrono::duration<.*std::ratio<1, 1000000000> ?>$", Duration)
    all_.add_printer("Time", r"^std::chrono::time_point<tessera::RunClock.*>$", Time)
    all_.add_printer("BoundedString", r"^tessera::BoundedString<.*>$", BoundedString)
    all_.add_printer("LargeArray", r"^tessera::LargeArray<.*>$", LargeArray)
    all_.add_printer("Buffer", r"^tessera::Buffer<.*>$", Buffer)
    return all_


gdb.printing.register_pretty_printer(None, printers(), replace=True)
