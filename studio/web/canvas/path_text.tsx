import { Fragment } from "react";

/** A path or name that may break after its dots and underscores; its text stays as it is, also when it is copied. */
export function PathText({ of }: { of: string }) {
  return of.split(/(?<=[._])/).map((part, at) => (
    <Fragment key={at}>
      {at > 0 && <wbr />}
      {part}
    </Fragment>
  ));
}
