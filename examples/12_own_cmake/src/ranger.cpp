#include "cart/ranger.hpp"

namespace approach::cart::ranger {

void listen(Context&, const Inputs& in, Memory&, Outputs& out) { out.range = in.echo; }

}  // namespace approach::cart::ranger
