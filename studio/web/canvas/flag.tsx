export interface Complaint {
  severity: "error" | "warning";
  messages: string[];
}

/** A dot at an element that has complaints. */
export const Flag = ({ of }: { of: Complaint | undefined }) =>
  of ? (
    <span
      className={`dot ${of.severity}`}
      role="img"
      aria-label={`${of.severity}: ${of.messages.join("; ")}`}
      title={of.messages.join("\n")}
    />
  ) : null;
