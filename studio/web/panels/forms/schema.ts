import text from "../../../../share/tessera/spec.schema.json";
import type { Schema } from "../../model/text/schema_fields";

/** The schema of specifications: the allowed keys and their meanings. */
export const schema = text as unknown as Schema;
