#pragma once

namespace tessera {

/// Opens the standard streams that the caller has closed (`2>&-`), so that no other file gets their numbers: text for
/// people would then be written into it, for example into a recording. Text for such a stream is an error, as before.
///
/// Threads: at the start of a process, before it opens files.
void open_missing_streams();

}  // namespace tessera
