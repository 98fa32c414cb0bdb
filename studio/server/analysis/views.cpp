#include "server/analysis/views.hpp"

#include <utility>

namespace tessera::server {

using nlohmann::json;

namespace {

const char* kind_name(project::WorldView::Kind kind) {
  switch (kind) {
    case project::WorldView::Kind::camera:
      return "camera";
    case project::WorldView::Kind::depth:
      return "depth";
    case project::WorldView::Kind::labels:
      return "labels";
    case project::WorldView::Kind::scan:
      break;
  }
  return "scan";
}

json view_json(const project::WorldView& view) {
  json told{{"path", view.path}, {"type", view.type}, {"kind", kind_name(view.kind)}};
  if (view.kind == project::WorldView::Kind::scan) {
    told.update({{"body", view.body},
                 {"position", view.position_m},
                 {"quaternion", view.quaternion},
                 {"from", view.from_rad},
                 {"to", view.to_rad},
                 {"reach", view.reach_m}});
  } else {
    told.update({{"width", view.width}, {"height", view.height}});
  }
  return told;
}

}  // namespace

json json_of(const std::vector<project::WorldView>& views) {
  json told = json::array();
  for (const project::WorldView& view : views) told.push_back(view_json(view));
  return {{"views", std::move(told)}};
}

}  // namespace tessera::server
