import { Api, hasToken, message, shareToken, takeToken } from "./api";
import { Arrangement } from "./arrangement";
import { Camera } from "./camera";
import { Connection } from "./stream/connection";
import { Coverages } from "./run/coverage";
import { Deployment } from "./deployment";
import { Dock } from "./dock/dock";
import { followDock } from "./dock/dock_view";
import { ElementEdits } from "./element_edits";
import { Emergency } from "./emergency";
import { Draft } from "./draft";
import { Editor, type Wish } from "./editor";
import type { Project, RunRequest, Verdict } from "../model/protocol";
import { linkTo, readLink, type Linked, type Moment } from "./link";
import type { ViewState } from "../model/view_state";
import { Measured } from "./times/measured";
import { Operator } from "./operate/operator";
import { Play } from "./play";
import { PlottedRecordings } from "./plots/plotted";
import { Plots } from "./plots/plots";
import { causesOf } from "../model/causes";
import type { Places } from "../model/dock/ready_layouts";
import { findThing, selectionAfter, structureOf, type Structure } from "../model/structure/structure";
import { Guide } from "./guide";
import { LayoutFile } from "./layout_file";
import { Lens } from "./lens";
import { Recordings } from "./recordings";
import { Repairs } from "./repairs";
import type { Replay } from "./run/replay";
import { RunLog } from "./run/run_log";
import { Runner } from "./run/runner";
import { Scene } from "./scene";
import { Sources } from "./sources";
import { Stage } from "./stage";
import { Store } from "./store";
import { Sweeps } from "./plots/sweeps";
import { Timing } from "./timing";
import { Trust } from "./trust";
import { Verifier } from "./verifier";
import { Worst } from "./times/worst";

const kept = "tessera.view";

function keptView(): Partial<ViewState> {
  try {
    return JSON.parse(sessionStorage.getItem(kept) ?? "{}") as Partial<ViewState>;
  } catch {
    return {};
  }
}

function linkedView(): Partial<ViewState> {
  const { moment: _, ...view } = readLink(location.hash);
  return view;
}

const fileOf = ({ folder, file }: Project) => `${folder}/${file}`;

/** Milliseconds between two changes of the address while time goes on. */
const linkPause = 400;

/** The whole state of the page, outside React. */
export class Studio {
  readonly api = new Api(takeToken());
  readonly connection = new Connection(this.api);
  readonly draft = new Draft(this.api);
  readonly editor = new Editor(this.api, this.draft);
  readonly elements = new ElementEdits(this);
  readonly layoutFile = new LayoutFile(this.api, this.draft);
  /** The stage for the net of the text, and for games on it. */
  readonly desk = new Stage();
  readonly play = new Play(this.desk);
  readonly verifier = new Verifier(this.api, this.draft, this.connection, (verdicts) => this.verified(verdicts));
  readonly timing = new Timing(this.api, this.draft);
  readonly worst = new Worst(this.api);
  readonly measured = new Measured(this.api, this.draft);
  readonly lens = new Lens(this.api);
  readonly repairs = new Repairs(this.api);
  readonly sources = new Sources(this.api, this.draft);
  readonly runner = new Runner(this.api, this.draft, this.connection);
  readonly trust = new Trust(this.api);
  readonly emergency = new Emergency(this.api, this.connection);
  readonly runLog = new RunLog(this.runner, this.connection, this.emergency);
  readonly operator = new Operator(this.api, this.runner);
  readonly deployment = new Deployment(this.runner, this.connection);
  readonly recordings = new Recordings(this.api, this.draft);
  readonly scene = new Scene(this.desk, this.runner, this.recordings);
  readonly sweeps = new Sweeps(this.api, this.connection);
  readonly arrangement = new Arrangement(this.api);
  readonly plots = new Plots(this.arrangement);
  readonly plotted = new PlottedRecordings(this.api, this.draft, this.scene, this.plots);
  readonly coverage = new Coverages(this.api, this.scene, this.runner);
  readonly camera = new Camera();
  readonly guide = new Guide(localStorage);
  readonly dock = new Dock(this.arrangement);
  /** The seconds that timelines and curves show. */
  readonly watched = new Store({ seconds: 10 });
  readonly project = new Store<{ project: Project | null; problem: string }>({ project: null, problem: "" });
  readonly view = new Store<ViewState>({
    view: "structure",
    panel: "inspect",
    // In a narrow window, the drawing needs the space.
    text: innerWidth > 900,
    theme: matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light",
    map: null,
    ...keptView(),
    selected: null,
    ...linkedView(),
    line: null,
    flight: null,
    near: null,
    folds: new Map(),
    searching: false,
  });
  /** The element that the last edit has selected. */
  private ledTo: string | null | undefined;
  /** The element that was renamed last: its form stays the one under its old name, with what is typed there. */
  private renamed = { path: "", form: "" };
  private serverStart: string | undefined;
  /** The time in the address, until its recording is open. */
  private wanted = readLink(location.hash).moment;
  private readonly linkedPanel = readLink(location.hash).panel;
  private linking: ReturnType<typeof setTimeout> | undefined;
  private reloading = false;

  /**
   * panels: all panels of the page. linked: the address tells what is shown, and this tab keeps it.
   */
  constructor(
    readonly panels: readonly Places[],
    private readonly linked = true,
  ) {
    followDock(this.view, this.dock);
    this.editor.saveOthers = () => this.sources.saveAll();
    this.draft.wrote = (files) => void this.sources.reread(files);
    this.view.subscribe(() => {
      const { view, panel, text, theme, map } = this.view.get();
      if (this.linked) sessionStorage.setItem(kept, JSON.stringify({ view, panel, text, theme, map }));
      this.link();
    });
    let followed: Replay | undefined;
    let leave = () => {};
    this.recordings.store.subscribe(() => {
      const first = this.recordings.store.get().open[0];
      if (first === followed) return;
      leave();
      followed = first;
      leave = first ? first.store.subscribe(() => this.linkSoon()) : () => {};
      this.link();
    });
    this.operator.watch(document, window);
    // After a reload, what is not saved is there again; after the tab is closed, it is gone.
    addEventListener("beforeunload", (event) => {
      // A field takes what is typed in it.
      (document.activeElement as HTMLElement | null)?.blur();
      if (this.unsaved && !this.reloading) event.preventDefault();
    });
    // An address that is opened in this tab changes only the part after the #.
    // The page may have written its own address again before it is told of that one.
    addEventListener("hashchange", ({ newURL }) => {
      const { hash } = new URL(newURL);
      return hasToken(hash) ? this.reload(newURL) : this.follow(readLink(hash));
    });
    this.draft.store.subscribe(() => {
      const { net } = this.draft.store.get();
      if (net && this.desk.mode === "edit" && !this.desk.is(net)) this.desk.reset(net, "edit");
    });
    this.connection.on("layout", ({ revision }) => void this.layoutFile.changedOnDisk(revision));
    this.connection.on("spec", (event) => this.fileChanged(event.revision));
    this.connection.on("hello", (event) => void this.greeted(event.server_start, event.revision));
  }

  /** Writes the shown content into the address. */
  private link(): void {
    const { view, panel, selected } = this.view.get();
    const shown = this.recordings.store.get().open[0];
    const moment = this.wanted ?? (shown && { recording: shown.name, time: shown.store.get().time });
    const link = linkTo({ view, panel, selected, ...(moment ? { moment } : {}) });
    if (this.linked && link !== location.hash) history.replaceState(null, "", location.pathname + location.search + link);
  }

  /** The same for a time that may change with every frame: browsers limit how often an address changes. */
  private linkSoon(): void {
    this.linking ??= setTimeout(() => {
      this.linking = undefined;
      this.link();
    }, linkPause);
  }

  /** Opens the recording and the time that an address names. */
  async goTo(moment: Moment): Promise<void> {
    this.wanted = moment;
    const shown = () => this.recordings.store.get().open[0];
    if (shown()?.name !== moment.recording) await this.replay(moment.recording, 0);
    const replay = shown();
    if (replay?.name === moment.recording) replay.seek(moment.time);
    if (this.wanted === moment) this.wanted = undefined;
    this.link();
  }

  async open(): Promise<void> {
    try {
      const asked = this.api.project();
      const arranged = this.arrangement.load();
      void Promise.all([asked, arranged]).then(
        ([project]) => this.beginDock(fileOf(project)),
        () => this.beginDock(""),
      );
      const [project] = await Promise.all([asked, this.editor.load(asked.then(fileOf)), this.layoutFile.load(), arranged]);
      this.project.set({ project, problem: "" });
      this.sources.restore(project.folder);
      this.plots.restore(fileOf(project));
    } catch (error) {
      this.project.set({ problem: message(error) });
    }
    const { view, selected } = this.view.get();
    if (selected !== null && view === "net") this.fly(selected);
    if (this.wanted) void this.goTo(this.wanted);
    this.connection.open();
    if (this.project.get().project) shareToken(this.api.token, (token) => this.connection.openWith(token));
  }

  /** The panels as they were kept for this project, and the one that the address names. */
  private beginDock(project: string): void {
    // The page for operators has no panels of its own to keep.
    if (this.panels.length === 0) return;
    this.dock.choose(this.view.get().panel);
    this.dock.begin(project, this.panels, innerWidth);
    if (this.linkedPanel) this.dock.open(this.linkedPanel);
  }

  /** The project may have changed with the file: its name, its simulated world. */
  private async describeProject(): Promise<void> {
    try {
      this.project.set({ project: await this.api.project() });
    } catch {
      // The connection reports that the server is gone.
    }
  }

  /** Unsaved text stays in this tab. */
  private reload(address = location.href): void {
    this.reloading = true;
    history.replaceState(null, "", address);
    location.reload();
  }

  private fileChanged(revision: string): void {
    void this.draft.changedOnDisk(revision);
    void this.describeProject();
  }

  /** The stream of events is open. Before, the server may have been restarted, or the file changed. */
  private async greeted(start: string, revision: string): Promise<void> {
    const known = this.serverStart;
    this.serverStart = start;
    if (known !== undefined) void this.layoutFile.load();
    if (!this.project.get().project) {
      const [project] = await Promise.all([this.api.project(), this.arrangement.load()]);
      this.project.set({ project, problem: "" });
      this.beginDock(fileOf(project));
      await this.editor.load(Promise.resolve(fileOf(project)));
      this.sources.restore(project.folder);
      this.plots.restore(fileOf(project));
    } else if (known !== undefined && known !== start) {
      const { project } = this.project.get();
      // Another project at this address: its text is not to be mixed with that of this page.
      if (project && fileOf(await this.api.project()) !== fileOf(project)) return this.reload();
      await this.draft.changedOnDisk("");
      this.draft.store.set({ notice: "The server was restarted; connected again" });
    } else if (revision !== this.draft.store.get().revision) this.fileChanged(revision);
  }

  private follow({ view = this.view.get().view, panel = this.view.get().panel, selected = null, moment }: Linked): void {
    // Before anything else is written into the address.
    this.wanted = moment;
    if (moment) void this.goTo(moment);
    this.view.set({ view, panel, selected });
    if (selected !== null && view === "net") this.fly(selected);
  }

  /** Shows the stuck subsystems if a violation names them. */
  private verified(verdicts: readonly Verdict[]): void {
    void this.timing.verify(this.verifier.store.get().text);
    const cause = causesOf(verdicts).find(({ atEnd, warning }) => atEnd.length > 0 && !warning);
    if (cause) this.lens.show(this.verifier.store.get().net, cause.atEnd, cause.title);
    else this.lens.close();
  }

  /** Opens the page for operators in a tab of its own, with the key of this one, but without its unsaved text. */
  openOperatingPage(): void {
    window.open(`operate#token=${this.api.token}`, "_blank", "noopener");
  }

  get unsaved(): boolean {
    return this.draft.dirty || this.sources.dirty;
  }

  /** Saves the specification and all C++, since a run uses the files on disk. false: not all of it is saved. */
  async saveAll(): Promise<boolean> {
    await this.draft.settled();
    if (this.draft.dirty && !(await this.draft.save())) return false;
    const saved = await this.sources.saveAll();
    if (!saved) this.runner.store.set({ problem: this.sources.store.get().problem });
    return saved;
  }

  /** Starts or follows a run. A game in play is closed. The code of a folder runs only if the user trusts it. */
  async run(request: RunRequest): Promise<void> {
    if ((request.kind === "simulate" || request.kind === "run") && !(await this.trust.given())) return;
    this.play.stop();
    await this.runner.start(request);
  }

  /** Follows another run of the server. A game in play is closed. */
  async followRun(run: string): Promise<void> {
    this.play.stop();
    await this.runner.follow(run);
  }

  /** Draws a run again whose pane was closed. */
  showRun(): void {
    this.play.stop();
    this.runner.show(true);
  }

  /** Opens a recording beside the first `keep` open ones. */
  async replay(name: string, keep: number): Promise<void> {
    this.play.stop();
    await this.recordings.open(name, keep);
  }

  select(path: string | null, showLine = true): void {
    const span = path === null ? undefined : this.draft.store.get().net?.find(path)?.span;
    this.view.set({ selected: path });
    if (showLine && span && span.line > 0) this.showLine(span.line);
  }

  /**
   * Does an edit of the specification and then selects what it leads to, unless the user has selected something else
   * meanwhile. The promise is false if the edit was refused.
   */
  change(wish: Wish, leadsTo: (now: Structure) => Partial<Pick<ViewState, "selected" | "panel">> = () => ({})): Promise<boolean> {
    const asked = this.view.get().selected;
    const renamed = typeof wish !== "function" && !Array.isArray(wish) && wish.do === "rename";
    return this.editor.change(wish, (before, moved) => {
      if (renamed) this.layoutFile.renamed((path) => selectionAfter(structureOf(before), path, moved));
      const { selected } = this.view.get();
      const next = leadsTo(structureOf(this.draft.text));
      if (next.selected !== undefined && (selected === asked || selected === this.ledTo)) {
        if (renamed) this.renamed = { path: next.selected ?? "", form: this.formOf(selected ?? "") };
        this.ledTo = next.selected;
        this.view.set(next);
      } else if (renamed && selected !== null) this.view.set({ selected: selectionAfter(structureOf(before), selected, moved) });
    });
  }

  /** The form of a selected element. */
  formOf(selected: string): string {
    return this.renamed.path === selected ? this.renamed.form : selected;
  }

  /** Selects an element of the structure, its line and its form. */
  choose(path: string | null, structure: Structure): void {
    const line = path === null ? undefined : findThing(structure, path)?.of.line;
    this.view.set({ selected: path, ...(path === null ? {} : { panel: "inspect" }) });
    if (line) this.showLine(line);
  }

  showLine(line: number): void {
    this.view.set({ line: { line, request: (this.view.get().line?.request ?? 0) + 1 } });
  }

  /** Selects an element, and shows it in the structure from near. */
  comeNear(path: string, structure: Structure): void {
    this.choose(path, structure);
    this.view.set({ view: "structure", near: path });
  }

  /** Moves the drawing of the net to an element. */
  fly(path: string): void {
    this.view.set({ view: "net", flight: { path, request: (this.view.get().flight?.request ?? 0) + 1 } });
  }

  /** The same, and selects it. */
  flyTo(path: string): void {
    this.fly(path);
    this.select(path);
  }

  fold(path: string, folded: boolean): void {
    this.foldMany([path], folded);
  }

  foldMany(paths: readonly string[], folded: boolean): void {
    const folds = new Map(this.view.get().folds);
    for (const path of paths) folds.set(path, folded);
    this.view.set({ folds });
  }
}
