import { useEffect, useMemo, useRef, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { message } from "../../live/api";
import type { Track } from "../../live/run/track";
import { Scans, viewsOf } from "../../live/views";
import type { WorldView } from "../../model/protocol";
import type { World } from "../../live/world";
import { robotsOf, type Robot } from "../../model/run/robots";
import { colourOf, cut, drawFleet } from "../fleet/draw_fleet";
import { drawWorld } from "./draw_world";
import { Painted } from "./painted";
import { Pictures } from "./pictures";
import type { World3d } from "./world_3d";

const kept = "tessera.world";

interface WorldPaneProps {
  /** The title of its run, if another one is shown beside it. */
  title: string;
  track: Track;
  beside: Track | null;
  none: string;
}

/** The simulated world: in three dimensions, or the path of a robot from above. */
export function WorldPane({ title, track, beside, none }: WorldPaneProps) {
  const world = useWorld(track);
  const [above, setAbove] = useState(() => sessionStorage.getItem(kept) === "above");
  const [problem, setProblem] = useState("");
  const [followed, setFollowed] = useState(-1);
  const [rays, setRays] = useState(true);
  const views = useViews(world);
  const scans = useMemo(() => views.filter(({ kind }) => kind === "scan"), [views]);
  const cameras = useMemo(() => views.filter(({ kind }) => kind !== "scan"), [views]);
  useEffect(() => {
    setProblem("");
    const timer = setInterval(() => world?.problem && setProblem(world.problem), 500);
    return () => clearInterval(timer);
  }, [world]);
  const inSpace = world !== null && !above && !problem;
  const robots = useMemo(() => (world ? robotsOf(world.scene.bodies) : []), [world]);
  const fleet = !inSpace && robots.filter(({ agent }) => agent).length > 1;
  const look = (next: boolean) => {
    sessionStorage.setItem(kept, next ? "above" : "space");
    setAbove(next);
    setProblem("");
  };
  return (
    <div className="watch-pane world">
      <div className="watch-title">
        {title && <h2 title={title}>{title}</h2>}
        {(inSpace || fleet) && world && <Followed world={world} followed={followed} onFollow={setFollowed} />}
        <span className="spring" />
        {inSpace && scans.length > 0 && (
          <button className="small" aria-pressed={rays} title="Scans as rays" onClick={() => setRays(!rays)}>
            Rays
          </button>
        )}
        {world && (
          <button className="small" aria-pressed={inSpace} title={problem} onClick={() => look(inSpace)}>
            3D
          </button>
        )}
        {!inSpace && <span className="faint">{problem || (track.path.length > 0 ? "from above" : "")}</span>}
      </div>
      {inSpace ? (
        <div className="seen">
          <Space
            track={track}
            beside={beside}
            world={world}
            scans={rays ? scans : noViews}
            followed={followed}
            onProblem={setProblem}
          />
          <Pictures track={track} views={cameras} />
        </div>
      ) : fleet ? (
        <>
          <Painted
            label="The robots from above"
            draw={(context, size, colours) => {
              const { now, floor } = track;
              const poses = world!.at(now);
              if (poses) drawFleet(context, size, colours, { robots, poses, paths: world!.paths, now, floor, followed });
            }}
            of={() => `${track.id} ${track.now} ${world!.paths.times.length} ${world!.at(track.now) !== null} ${followed}`}
          />
          <Legend robots={robots} />
        </>
      ) : (
        <Painted
          label="The robot's path from above"
          draw={(context, size, colours) => drawWorld(context, size, colours, track, none)}
          of={() => `${track.id} ${track.driven} ${track.path.length} ${track.floor !== null}`}
        />
      )}
    </div>
  );
}

/** The colours of the robots. A click on a name selects its agent in the drawing. */
function Legend({ robots }: { robots: readonly Robot[] }) {
  const studio = useStudio();
  return (
    <ul className="robots" aria-label="Robots">
      {robots.map(({ name, agent }, at) =>
        agent ? (
          <li key={name}>
            <button className="link" title={name} onClick={() => studio.flyTo(agent)}>
              <i style={{ background: colourOf(at) }} />
              <span>{cut(name, 20)}</span>
            </button>
          </li>
        ) : null,
      )}
    </ul>
  );
}

const noViews: readonly WorldView[] = [];

/** The devices whose values can be shown. */
function useViews(world: World | null): readonly WorldView[] {
  const studio = useStudio();
  const revision = useStore(studio.draft.store, (draft) => draft.revision);
  const [views, setViews] = useState(noViews);
  useEffect(() => {
    let closed = false;
    if (world) void viewsOf(studio.api).then((found) => !closed && setViews(found));
    return () => void (closed = true);
  }, [world, revision]);
  return views;
}

/** The world of a track, which may come later than the track. */
function useWorld(track: Track): World | null {
  const [world, setWorld] = useState(track.world);
  useEffect(() => {
    setWorld(track.world);
    const timer = setInterval(() => setWorld(track.world), 200);
    return () => clearInterval(timer);
  }, [track]);
  return world;
}

function Followed({ world, followed, onFollow }: { world: World; followed: number; onFollow: (body: number) => void }) {
  return (
    <select aria-label="Body to follow" value={followed} onChange={(event) => onFollow(Number(event.target.value))}>
      <option value={-1}>whole world</option>
      {world.scene.bodies.map(([name], body) => (
        <option key={name} value={body}>
          {name}
        </option>
      ))}
    </select>
  );
}

interface SpaceProps {
  track: Track;
  /** Its run is shown as ghosts, if it is in the same world. */
  beside: Track | null;
  world: World;
  scans: readonly WorldView[];
  followed: number;
  onProblem: (problem: string) => void;
}

const posesOf = ({ world, now }: Track) => world?.at(now) ?? null;

/** A click on a body selects its agent in the drawing. */
function Space({ track, beside, world, scans, followed, onProblem }: SpaceProps) {
  const studio = useStudio();
  const canvas = useRef<HTMLCanvasElement>(null);
  const view = useRef<World3d | null>(null);
  const rays = useMemo(() => new Scans(scans, world.scene.bodies), [scans, world]);
  const shown = useRef({ track, beside, rays });
  shown.current = { track, beside, rays };
  const { hash } = world.scene;
  useEffect(() => {
    // React forgets the element before it closes the view, which may draw meanwhile.
    const element = canvas.current!;
    let closed = false;
    const open = async () => {
      try {
        const [{ World3d }, glb] = await Promise.all([import("./world_3d"), studio.api.scene(hash)]);
        if (closed) return;
        const made = new World3d(element, {
          poses: () => posesOf(shown.current.track),
          ghosts: () => (shown.current.beside?.world?.scene.hash === hash ? posesOf(shown.current.beside) : null),
          scans: () => shown.current.rays.at(shown.current.track),
          background: () => getComputedStyle(element).getPropertyValue("--sunken").trim(),
          picked: (body) => {
            const agent = world.scene.bodies[body]?.[1];
            if (agent) studio.flyTo(agent);
          },
          lost: () => onProblem("The view in three dimensions was lost."),
        });
        view.current = made;
        Object.assign(element, { view: made });
        await made.load(glb, world.scene.bodies.length);
      } catch (error) {
        if (!closed) onProblem(message(error));
      }
    };
    void open();
    return () => {
      closed = true;
      view.current?.close();
      view.current = null;
    };
  }, [hash]);
  useEffect(() => view.current?.follow(followed), [followed]);
  return <canvas ref={canvas} className="painted space" role="img" aria-label="The world in three dimensions" tabIndex={0} />;
}
