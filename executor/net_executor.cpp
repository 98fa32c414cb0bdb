#include "tessera/net_executor.hpp"

#include <utility>

#include "executor/net_machine.hpp"

namespace tessera {

std::unique_ptr<NetExecutor> NetExecutor::load(ExecutableNet net, Options options, std::string& error) {
  std::optional<FiringProgram> program = compile(net, options.bound, error);
  if (!program) return nullptr;
  return std::unique_ptr<NetExecutor>(
      new NetExecutor(std::make_unique<NetMachine>(std::move(net), std::move(options), std::move(*program))));
}

NetExecutor::NetExecutor(std::unique_ptr<NetMachine> machine) : machine_(std::move(machine)) {}
NetExecutor::~NetExecutor() = default;

NetExecutor::Outcome NetExecutor::run(std::uint64_t most) { return machine_->run(most); }
void NetExecutor::stop() { machine_->stop(); }
void NetExecutor::reconsider() { machine_->reconsider(); }
std::vector<std::uint32_t> NetExecutor::marking() const { return machine_->marking(); }
std::vector<std::uint32_t> NetExecutor::enabled() const { return machine_->enabled(); }

}  // namespace tessera
