#include "assembly/restart.hpp"

#include <exception>

namespace tessera {

void RestartingAssembler::kill(std::uint32_t process) {
  if (assembly_.links != nullptr) assembly_.links->kill(process);
}

bool RestartingAssembler::restart(std::uint32_t process, network::Incarnation incarnation,
                                  std::string& error) try {
  error_.clear();
  const bool made = make_subsystems(process) && link_again(process) && set_values_again(process) &&
                    make_channels_again(process, incarnation) && replace_executors(process);
  error = error_;
  return made;
} catch (const std::exception& exception) {  // constructors of user code
  error = exception.what();
  return false;
}

bool RestartingAssembler::is_in(const End& end, std::uint32_t process) const {
  return end.is_used() && system_.process_of[end.instance] == process;
}

bool RestartingAssembler::make_subsystems(std::uint32_t process) {
  DeviceFinder finder(system_, assembly_.options, assembly_.world.get());
  for (std::uint32_t index = 0; index < parts_.size(); ++index) {
    if (system_.process_of[index] != process) continue;
    parts_[index] = {};
    bind(parts_[index], index);
    find_devices(finder, parts_[index]);
    if (parts_[index].drivers.size() != assembly_.executors[index]->operations().parts().drivers.size())
      return fail(finder.complaints().value_or(Problem{}).text);
  }
  return true;
}

bool RestartingAssembler::link_again(std::uint32_t process) {
  for (std::uint32_t index = 0; index < system_.channels.size(); ++index) {
    const Channel& channel = system_.channels[index];
    for (const Side side : {Side::send, Side::receive}) {
      const End& end = side == Side::send ? channel.from : channel.to;
      const End& other = side == Side::send ? channel.to : channel.from;
      if (!is_in(end, process)) continue;
      if (!link(channel, end, other, side)) return false;
      if (part_.is_networked(index)) link_remote(end, other);
    }
  }
  return true;
}

/// A name without an index means all subsystems. The running ones then get values, too: copies of them.
bool RestartingAssembler::set_values_again(std::uint32_t process) {
  std::vector<ParameterOwner> all;
  std::vector<std::pair<std::unique_ptr<Subsystem>, std::unique_ptr<Bindings>>> copies;
  for (std::uint32_t index = 0; index < parts_.size(); ++index) {
    const Instance& instance = system_.instances[index];
    if (system_.process_of[index] == process) {
      all.push_back({parts_[index].path, parts_[index].bindings.parameters});
      continue;
    }
    copies.emplace_back(instance.make(), std::make_unique<Bindings>());
    copies.back().first->bind(*copies.back().second);
    all.push_back({path_of(instance), copies.back().second->parameters});
  }
  return set_parameters(all, assembly_.options.parameters, error_);
}

bool RestartingAssembler::make_channels_again(std::uint32_t process, network::Incarnation incarnation) {
  for (std::uint32_t index = 0; index < system_.channels.size(); ++index) {
    const Channel& channel = system_.channels[index];
    const bool sends = is_in(channel.from, process), receives = is_in(channel.to, process);
    if (!sends && !receives) continue;
    Assembly::Words& words = assembly_.channels[index];
    Assembly::Words& dead = assembly_.dead_channels.emplace_back();
    if (!part_.is_networked(index)) {
      dead.of_sender = std::move(words.of_sender);
      if (!make_local(index)) return false;
      continue;
    }
    if (sends) dead.of_sender = std::move(words.of_sender);
    if (receives) dead.of_receiver = std::move(words.of_receiver);
    if ((sends && !make_networked(index, Side::send, incarnation)) ||
        (receives && !make_networked(index, Side::receive, incarnation)))
      return false;
  }
  return true;
}

/// Effectors first, as at every start.
bool RestartingAssembler::replace_executors(std::uint32_t process) {
  const auto bindings_of = [](const std::unique_ptr<SubsystemExecutor>& executor) -> const Bindings& {
    return executor->operations().parts().bindings;
  };
  std::uint32_t first_buffer = 0, first_memory = 0;
  for (const auto& executor : assembly_.executors) first_memory += count_buffers(bindings_of(executor));
  for (std::uint32_t index = 0; index < parts_.size(); ++index) {
    std::unique_ptr<SubsystemExecutor>& executor = assembly_.executors[index];
    if (system_.process_of[index] == process) {
      record_values_of(assembly_, parts_[index], first_buffer, first_memory);
      assembly_.dead.push_back(std::move(executor));
      executor = make_executor(index);
      assembly_.control.mark_ended(index, false);
      assembly_.control.mark_stalled(index, false);
    }
    first_buffer += count_buffers(bindings_of(executor));
    first_memory += count_memory(bindings_of(executor), value_limit(assembly_.options));
  }
  for (const bool effectors : {true, false})
    for (std::uint32_t index = 0; index < parts_.size(); ++index) {
      if (system_.process_of[index] != process) continue;
      Operations& operations = assembly_.executors[index]->operations();
      if (operations.devices().none() != effectors && !operations.devices().open(error_)) return false;
    }
  return true;
}

}  // namespace tessera
