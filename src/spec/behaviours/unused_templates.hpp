#pragma once

#include "spec/behaviours/group_templates.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {

/// Reads the templates of groups that nothing uses, as far as they can be judged without the subsystem that their other
/// names belong to: keys, forms, and how their behaviours lead to one another.
///
/// Errors: those of read_behaviours, but for names of buffers, memory, parameters and conditions, and for what follows
///         from their types. Warnings: W319.
void check_unused(GroupTemplates& templates, const Types& types, Diagnostics& out);

}  // namespace tessera::spec
