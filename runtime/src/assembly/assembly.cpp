#include "assembly/assembly.hpp"

#include <exception>
#include <memory>

#include "assembly/assembler.hpp"
#include "assembly/restart.hpp"

namespace tessera {

bool assemble(Assembly& assembly, const Clock& clock, Waker& waker, std::string& error) try {
  auto assembler = std::make_unique<RestartingAssembler>(assembly, clock, &waker, error);
  if (!assembler->run()) return false;
  if (!assembly.outages.empty()) assembly.restarts = std::move(assembler);
  return true;
} catch (const std::exception& exception) {  // constructors of user code: memory, drivers
  error = exception.what();
  return false;
}

bool take_apart(Assembly& assembly, const Clock& clock, LooseParts& parts, std::string& error) try {
  return Assembler(assembly, clock, nullptr, error).run(parts);
} catch (const std::exception& exception) {
  error = exception.what();
  return false;
}

}  // namespace tessera
