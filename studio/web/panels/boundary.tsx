import { Component, type ReactNode } from "react";

/** A part of the page that shows its error if it fails, and can be drawn again; the text beside it stays. */
export class Boundary extends Component<{ children: ReactNode }, { problem: string | null }> {
  override state = { problem: null as string | null };

  static getDerivedStateFromError(error: unknown) {
    return { problem: error instanceof Error ? error.message : String(error) };
  }

  override render() {
    if (this.state.problem === null) return this.props.children;
    return (
      <div className="empty" role="alert">
        <h2>This part of the page failed</h2>
        <p>{this.state.problem}</p>
        <p>Your text is safe.</p>
        <button onClick={() => this.setState({ problem: null })}>Draw it again</button>
      </div>
    );
  }
}
