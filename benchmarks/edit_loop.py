#!/usr/bin/env python3
"""The edit loop of a depot with 16 subsystems in 5 agents: processor seconds of compiler and linker.

edit_loop.py TESSERA FOLDER [PACKAGE]

Writes the depot into FOLDER, which must not exist, and builds it: at first, with nothing changed, with a comment at
the top of spec.yaml, with a changed condition, and with a changed function. PACKAGE: the folder with
tesseraConfig.cmake; by default that of the build of TESSERA. Compilers are started without a cache.
"""
import pathlib
import resource
import subprocess
import sys

AGENTS = {
    "dispatcher": [],
    "lift": [("height", "receptor"), ("winch", "effector")],
    "picker": [("scanner", "receptor"), ("arm", "effector"), ("gripper", "effector")],
    "cart": [("laser", "receptor"), ("bumper", "receptor"), ("base", "effector")],
    "packer": [("scale", "receptor"), ("belt", "effector"), ("printer", "effector")],
}
WORKERS = [agent for agent in AGENTS if agent != "dispatcher"]
BEHAVIOURS = ["wait", "approach", "work", "leave", "recover"]
HEAD = """# The depot
tessera: 1
system: depot
types:
  Reading: { value: float64 m, quality: float32, valid_count: uint32 }
  Command: { speed: float64 m/s, turn: float64 rad/s, hold: bool }
  Order:   { number: uint32, shelf: uint32, weight: float64 kg }
  Report:  { number: uint32, done: bool, broken: bool, progress: float64 }
  Cloud:   { ranges: "float32[64] m", known: bool }
parameters: { cruise: 0.4 m/s, patience: 3.0 }
agents:
"""
DRIVERS = """#pragma once
#include <array>
#include <optional>
#include <tessera/device.hpp>

class Sensor final : public tessera::Receptor<double> {
 public:
  std::optional<double> read() override { return 0.5; }
};
class Ranges final : public tessera::Receptor<std::array<float, 64>> {
 public:
  std::optional<std::array<float, 64>> read() override { return std::array<float, 64>{}; }
};
class Wheel final : public tessera::Effector<double> {
 public:
  bool write(const double&) override { return true; }
};
"""


def source(agent, name, functions):
    bodies = "".join(f"void {f}(Context& context, const Inputs& in, Memory& memory, Outputs& out) {{\n{body}}}\n"
                     for f, body in functions.items())
    needed = "#include <algorithm>\n#include <cmath>\n" if name == "control" else ""
    return (f'#include "{agent}/{name}.hpp"\n{needed}'
            f"namespace depot::{agent}::{name} {{\n{bodies}}}\n")


def control(agent, devices):
    """Its lines of the specification, and its source."""
    if agent == "dispatcher":
        inputs = [f"{one}: Report" for one in WORKERS]
        outputs = [f"{one}_order: Order" for one in WORKERS]
        sends = "".join(f"  out.{one}_order.number = memory.number;\n" for one in WORKERS)
    else:
        inputs = ["order: Order"] + [f"{name}: {'Cloud' if name == 'laser' else 'Reading'}"
                                     for name, kind in devices if kind == "receptor"]
        commands = [name for name, kind in devices if kind == "effector"]
        outputs = ["report: Report"] + [f"{name}: Command" for name in commands]
        sends = "  out.report = {memory.number, memory.held, false, memory.progress};\n" + "".join(
            f"  out.{name} = {{context.parameters.cruise, memory.level, memory.held}};\n" for name in commands)
    lines = f"""  {agent}:
    control:
      rate: 20 Hz
      inputs:  {{ {', '.join(inputs)} }}
      outputs: {{ {', '.join(outputs)} }}
      memory:  {{ number: uint32, steps: uint32, progress: float64, held: bool, level: float64 }}
      parameters: {{ limit: 40.0, gain: {{ default: 0.5, min: 0, max: 2 }} }}
      behaviours:
"""
    for at, name in enumerate(BEHAVIOURS):
        following = BEHAVIOURS[(at + 1) % len(BEHAVIOURS)]
        lines += f"""        {name}:
          terminal: {{ done: memory.steps > {10 + at} && memory.progress >= 0.5, held: memory.held }}
          error:    {{ late: elapsed > {20 + at} s, lost: memory.level < -{at + 1}.0 }}
          next:     [{{ to: recover, when: error }}, {{ to: {following}, when: done }}, wait]
"""
    return lines, source(agent, "control", {name: f"""  ++memory.steps;
  memory.progress = std::min(1.0, memory.progress + 0.01 * context.parameters.gain);
  memory.level = std::sqrt(std::abs(memory.progress));
  if (memory.steps % 100 == 0) context.log("{name}: {{}} steps, level {{:.2f}}", memory.steps, memory.level);
{sends}""" for name in BEHAVIOURS})


def device(agent, name, kind):
    """Its lines of the specification, its channel, its drivers, and its source."""
    if kind == "receptor":
        is_laser = name == "laser"
        lines = f"""      {name}:
        rate: 50 Hz
        real: {{ raw: {'"float32[64] m"' if is_laser else 'float64'} }}
        outputs: {{ out: {'Cloud' if is_laser else 'Reading'} }}
        behaviours: {{ look: {{}} }}
"""
        body = "  out.out.ranges = in.raw;\n" if is_laser else "  out.out.value = in.raw;\n"
        return (lines, f"  - {agent}.{name}.out -> {agent}.control.{name}\n",
                f"  {agent}.{name}.raw: {{ cpp: {'Ranges' if is_laser else 'Sensor'} }}\n",
                source(agent, name, {"look": body}))
    lines = f"""      {name}:
        rate: 50 Hz
        inputs: {{ command: Command }}
        real: {{ left: float64, right: float64 }}
        stale: 500 ms
        limits: {{ left: {{ min: -5, max: 5 }} }}
        behaviours: {{ drive: {{}} }}
"""
    return (lines, f"  - {{ from: {agent}.control.{name}, to: {agent}.{name}.command, receive: blocking, timeout: 200 ms }}\n",
            "".join(f"  {agent}.{name}.{side}: {{ cpp: Wheel }}\n" for side in ("left", "right")),
            source(agent, name, {"drive": "  out.left = in.command.speed - in.command.turn;\n"
                                          "  out.right = in.command.speed + in.command.turn;\n"}))


def write_depot(project):
    text, channels, drivers, sources = HEAD, "channels:\n", "drivers:\n", {"drivers.hpp": DRIVERS}
    for one in WORKERS:
        channels += f"  - dispatcher.control.{one}_order -> {one}.control.order\n"
        channels += f"  - {one}.control.report -> dispatcher.control.{one}\n"
    for agent, devices in AGENTS.items():
        lines, sources[f"{agent}/control.cpp"] = control(agent, devices)
        text += lines
        for kind in ("receptor", "effector"):
            of_kind = [name for name, its in devices if its == kind]
            text += f"    {kind}s:\n" if of_kind else ""
            for name in of_kind:
                lines, channel, driver, sources[f"{agent}/{name}.cpp"] = device(agent, name, kind)
                text, channels, drivers = text + lines, channels + channel, drivers + driver
    for path, its in sources.items():
        (project / "src" / path).parent.mkdir(parents=True, exist_ok=True)
        (project / "src" / path).write_text(its)
    (project / "spec.yaml").write_text(text + channels + drivers)


def processor_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    tessera, project = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    package = sys.argv[3] if len(sys.argv) > 3 else tessera.parent / "lib/cmake/tessera"
    project.mkdir()
    write_depot(project)
    spec, function = project / "spec.yaml", project / "src/cart/control.cpp"
    generated, build = project / ".tessera/generated", project / "built"

    def measure(title):
        subprocess.run([tessera, "generate", project], check=True, stdout=subprocess.DEVNULL)
        if not build.exists():
            subprocess.run(["cmake", "-S", generated, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            "-DCMAKE_CXX_COMPILER=g++", f"-Dtessera_DIR={package}",
                            f"-DTESSERA_PROJECT_DIR={project}"], check=True, stdout=subprocess.DEVNULL)
        taken = processor_seconds(["cmake", "--build", build, "--target", "controller"])
        print(f"{title:<20}{taken:6.2f} s", flush=True)

    measure("first build")
    measure("nothing changed")
    spec.write_text("# A comment\n" + spec.read_text())
    measure("comment")
    spec.write_text(spec.read_text().replace("memory.steps > 12 &&", "memory.steps > 13 &&", 1))
    measure("condition")
    function.write_text(function.read_text().replace("++memory.steps;", "memory.steps += 2;", 1))
    measure("function")


main()
