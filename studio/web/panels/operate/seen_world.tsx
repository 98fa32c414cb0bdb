import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Track } from "../../live/run/track";
import { WorldPane } from "../world/world_pane";

/** The simulated world, or the path of the robot. Without both it takes no room. */
export function SeenWorld() {
  const track = useTrack();
  const there = useSomethingSeen(track);
  return track && there ? <WorldPane title="" track={track} beside={null} none="" /> : null;
}

/** The data of the followed run. */
export function useTrack(): Track | null {
  const studio = useStudio();
  useStore(studio.runner.store, (all) => `${all.run} ${all.shown} ${all.state}`);
  return studio.runner.track;
}

function useSomethingSeen(track: Track | null): boolean {
  const [there, setThere] = useState(false);
  useEffect(() => {
    const look = () => setThere(track !== null && (track.world !== null || track.path.length > 0));
    const timer = setInterval(look, 300);
    look();
    return () => clearInterval(timer);
  }, [track]);
  return there;
}
