#include "verify_circuits/judged.hpp"

#include <stdexcept>
#include <utility>

#include "layers/layers.hpp"
#include "net/flatten.hpp"

namespace tessera::test {

net::Net flat_net(const spec::Model& model) {
  diagnostics::Diagnostics out("system.yaml", "");
  const auto pages = layers::build(model, out);
  auto net = pages ? net::flatten(*pages, out) : std::nullopt;
  if (!net) throw std::runtime_error(diagnostics::render(out));
  return std::move(*net);
}

Judged judge(const net::Net& net, verify::Assume assume) {
  verify::CommunicationResult read = verify::communication_structure(net, assume);
  if (!read.structure) throw std::runtime_error(read.why_not);
  Judged judged{std::move(*read.structure), {}};
  judged.report = verify::judge_circuits(judged.structure);
  return judged;
}

Judged judge(const spec::Model& model, verify::Assume assume) { return judge(flat_net(model), assume); }

namespace {

std::string text_of(const verify::Communication& communication) {
  std::string text = communication.side == verify::Side::send ? "send " : "receive ";
  text += std::to_string(communication.flow.value);
  if (communication.blocking) text += "!";
  if (communication.timeout) text += "~";
  return text;
}

std::string text_of(const verify::Stage& stage) {
  std::string text;
  for (const verify::Communication& communication : stage)
    text += (text.empty() ? "" : " | ") + text_of(communication);
  return stage.size() > 1 ? "[" + text + "]" : text;
}

std::string text_of(const verify::SubsystemFlow& subsystem, const verify::BehaviourFlow& behaviour) {
  std::string text = behaviour.name + ":";
  for (const verify::Stage& stage : behaviour.stages) text += " " + text_of(stage) + ",";
  if (behaviour.repeats) text += " repeats";
  for (const std::uint32_t next : behaviour.next) text += " -> " + subsystem.behaviours[next].name;
  if (behaviour.ends) text += " -> end";
  if (!behaviour.complete) text += " -> nowhere";
  return text;
}

}  // namespace

std::string in_text(const verify::CommunicationStructure& structure) {
  std::string text;
  for (const verify::SubsystemFlow& subsystem : structure.subsystems)
    for (const verify::BehaviourFlow& behaviour : subsystem.behaviours)
      text += text_of(subsystem, behaviour) + "\n";
  return text;
}

}  // namespace tessera::test
