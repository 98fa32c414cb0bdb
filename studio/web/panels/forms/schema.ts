import text from "../../../../share/tessera/spec.schema.json";
import type { Schema } from "../../model/text/schema_fields";

/** The schema of specifications. It says which keys may stand where, and what they mean. */
export const schema = text as unknown as Schema;
