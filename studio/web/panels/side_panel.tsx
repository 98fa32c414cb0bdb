import { useStore, useStudio } from "../hooks/use";
import type { PanelName } from "../model/view_state";
import { InspectPanel } from "./inspect_panel";
import { PlayPanel } from "./run/play_panel";
import { RecordingsPanel } from "./run/recordings_panel";
import { RunPanel } from "./run/run_panel";
import { VerifyPanel } from "./verify_panel";

const panels: { name: PanelName; title: string }[] = [
  { name: "inspect", title: "Element" },
  { name: "verify", title: "Verify" },
  { name: "play", title: "Play" },
  { name: "run", title: "Run" },
  { name: "recordings", title: "Recordings" },
];

export function SidePanel() {
  const studio = useStudio();
  const panel = useStore(studio.view, (view) => view.panel);
  return (
    <>
      <div className="tabs" role="tablist" aria-label="Panels">
        {panels.map(({ name, title }) => (
          <button
            key={name}
            role="tab"
            id={`tab-${name}`}
            aria-selected={panel === name}
            aria-controls="panel"
            onClick={() => studio.view.set({ panel: name })}
          >
            {title}
          </button>
        ))}
      </div>
      <div className="panel" id="panel" role="tabpanel" aria-labelledby={`tab-${panel}`}>
        <Content panel={panel} />
      </div>
    </>
  );
}

function Content({ panel }: { panel: PanelName }) {
  switch (panel) {
    case "verify":
      return <VerifyPanel />;
    case "play":
      return <PlayPanel />;
    case "run":
      return <RunPanel />;
    case "recordings":
      return <RecordingsPanel />;
    default:
      return <InspectPanel />;
  }
}
