import type { Now } from "../../live/editor";
import { driverKinds, type DriverKind, type FieldShape } from "../../model/text/schema_fields";
import { replace, set } from "../../model/text/edits";
import { listAsTyped } from "../../model/text/list_text";
import { fieldsFor } from "../../model/text/value_shape";
import type { Structure } from "../../model/structure/structure";
import { withoutIndex } from "../../model/structure/structure";
import type { YamlPath } from "../../model/text/yaml_text";
import { Choice, Field } from "./field";
import { useEdit } from "./form_parts";
import { MapForm } from "./map_form";
import { ObjectFields } from "./object_fields";
import { driverHelp } from "./form_help";
import { schema } from "./schema";
import { OwnProblem, useProblems } from "./use_problems";
import type { Targets } from "./targets";

const kinds = driverKinds(schema);

/** The real buffers, in the order of the text. */
const realBuffers = (structure: Structure) =>
  structure.agents.flatMap((agent) =>
    agent.subsystems.flatMap((one) =>
      one.buffers
        .filter(({ direction }) => direction === "real")
        .map(({ name }) => ({ kind: one.kind, path: `${agent.name}${agent.count ? "[*]" : ""}.${one.name}.${name}` })),
    ),
  );

const sideOf = (structure: Structure, path: string) =>
  structure.agents
    .flatMap(({ subsystems }) => subsystems)
    .find((one) => withoutIndex(path) === one.path || withoutIndex(path).startsWith(`${one.path}.`))?.kind;

/** The kinds that fit a real buffer in the world, or at the real robot. */
const fitting = (side: string | undefined, where: "world" | "robot") =>
  kinds.filter((one) => (one.side === "both" || one.side === side) && (one.where === "both" || one.where === where));

const firstTarget = (kind: DriverKind, targets: Targets) =>
  ({ cpp: "Device", panel: "true", ros2: "/topic" })[kind.kind] ?? targets[kind.kind]?.[0] ?? "name";

interface DriversFormProps {
  structure: Structure;
  where: "world" | "robot";
  targets: Targets;
}

/** The drivers of one section: the device behind each real buffer. */
export function DriversForm({ structure, where, targets }: DriversFormProps) {
  const at: YamlPath = where === "world" ? ["simulation", "drivers"] : ["drivers"];
  const driven = structure.yaml.keys(at);
  const buffers = realBuffers(structure);
  const free = buffers.find(({ path }) => !driven.some((one) => path === one || path.startsWith(`${one}.`)));
  const possible = fitting(free?.kind, where);
  const first = possible.find(({ kind }) => (targets[kind]?.length ?? 0) > 0) ?? possible[0]!;
  return (
    <MapForm
      structure={structure}
      at={at}
      title={where === "world" ? "Drivers in the world" : "Drivers of the real robot"}
      one="driver"
      wrong={() => undefined}
      names={buffers.map(({ path }) => path)}
      fresh={{
        name: free?.path ?? "robot.sensor.device",
        value: { [first.kind]: firstTarget(first, targets) },
      }}
      fields={(name) => <DriverFields structure={structure} at={[...at, name]} where={where} targets={targets} />}
      {...(buffers.length === 0 ? { hint: "A driver is the device behind a real buffer of a receptor or an effector" } : {})}
    />
  );
}

/** The fields of a driver as it is now: those of a topic are not those of a service. */
function optionsOf({ kind, options }: DriverKind, value: unknown): readonly FieldShape[] {
  const definition = { ros2: "ros2_device", panel: "panel_device" }[kind];
  return definition ? fieldsFor({ $ref: `#/$defs/${definition}` }, schema, value) : options;
}

/** The kind of a driver and its device. */
function driverAt({ yaml }: Structure, at: YamlPath) {
  const keys = yaml.keys(at);
  const is = kinds.find(({ kind }) => keys.includes(kind));
  return { is, target: is ? (yaml.valueText([...at, is.kind]) ?? "") : "" };
}

interface DriverFieldsProps {
  structure: Structure;
  at: YamlPath;
  where: "world" | "robot";
  targets: Targets;
}

function DriverFields({ structure, at, where, targets }: DriverFieldsProps) {
  const { yaml } = structure;
  const edit = useEdit();
  const problem = useProblems(structure);
  const { is, target } = driverAt(structure, at);
  const possible = fitting(sideOf(structure, String(at.at(-1))), where);
  const choices = is && !possible.includes(is) ? [is, ...possible] : possible;
  const choose = (kind: string) => {
    const next = kinds.find((one) => one.kind === kind)!;
    return edit((now) => {
      // Options belong to a kind. A target that the new kind also has stays.
      const { target } = driverAt(now.structure, now.at(at));
      const kept = targets[kind]?.includes(target) ? target : firstTarget(next, targets);
      return replace(at, { [kind]: kept, ...(kind === "ros2" ? { type: "std_msgs/msg/Float64" } : {}) });
    });
  };
  /** The kind may have been changed since the user saw it. */
  const kindNow = (now: Now) => (driverAt(now.structure, now.at(at)).is ?? is)!.kind;
  return (
    <>
      <Choice
        label="Kind"
        value={is?.kind ?? ""}
        choices={[
          ...(is ? [] : [{ value: "", title: "…" }]),
          ...choices.map(({ kind }) => ({ value: kind, title: kind.replaceAll("_", " ") })),
        ]}
        onChange={choose}
      />
      {is && (
        <>
          <OwnProblem structure={structure} at={at} />
          {is.kind !== "panel" && (
            <Field
              label="Device"
              value={listAsTyped(target)}
              hint={is.description}
              choices={targets[is.kind] ?? []}
              problem={problem([...at, is.kind])}
              onChange={(text) => text.trim() !== "" && edit((now) => set(at, kindNow(now), text, "list"))}
            />
          )}
          <ObjectFields
            structure={structure}
            at={at}
            shapes={optionsOf(is, yaml.data(at))}
            without={is.kind === "panel" ? [] : [is.kind]}
            open={is.open}
            strays
            help={driverHelp}
          />
        </>
      )}
    </>
  );
}
