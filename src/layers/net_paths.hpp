#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "net/property.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

/// Finds the places of a flat net that the paths of properties mean.
class NetPaths {
 public:
  NetPaths(const spec::Model& model, const net::HierarchicalNet& pages, const net::Net& net);

  /// The places of a path, of a path with `to`, or of the values that fit a comparison: a statement of kind
  /// token.
  ///
  /// Errors: those of properties().
  [[nodiscard]] std::optional<net::Statement> find(const spec::Statement& token,
                                                   diagnostics::Diagnostics& out) const;

 private:
  using Parts = std::vector<spec::PathPart>;

  [[nodiscard]] std::optional<net::Statement> in_page(net::PageId page, const spec::NetPath& path,
                                                      std::size_t part, diagnostics::Diagnostics& out) const;
  [[nodiscard]] std::optional<net::Statement> of_buffer(net::SubsystemId subsystem, const spec::NetPath& path,
                                                        diagnostics::Diagnostics& out) const;
  /// `fresh` of an input, `timed_out` of an output.
  [[nodiscard]] std::optional<net::Statement> of_outcome(net::SubsystemId subsystem,
                                                         const spec::NetPath& path,
                                                         diagnostics::Diagnostics& out) const;
  [[nodiscard]] std::optional<net::Statement> of_memory(net::PageId page, const spec::Statement& token,
                                                        diagnostics::Diagnostics& out) const;
  [[nodiscard]] std::optional<net::Statement> of_channel(const spec::NetPath& from, const spec::NetPath& to,
                                                         diagnostics::Diagnostics& out) const;
  [[nodiscard]] std::optional<net::Statement> state(const std::string& channel, const spec::PathPart& part,
                                                    diagnostics::Diagnostics& out) const;
  [[nodiscard]] net::Statement whole_page(net::PageId page) const;
  /// The page of the subsystem whose memory the path names; none: it names something else.
  [[nodiscard]] net::PageId owner_of_memory(const spec::Statement& token) const;
  [[nodiscard]] std::optional<net::PlaceId> own_place(net::PageId page, const std::string& local) const;
  void complain(net::PageId page, const spec::PathPart& part, diagnostics::Diagnostics& out) const;

  const spec::Model& model_;
  const net::HierarchicalNet& pages_;
  std::unordered_map<std::string, net::PlaceId> places_;
  std::unordered_map<std::string, net::PageId> agents_;
  std::vector<std::vector<net::PlaceId>> own_;   // per page
  std::vector<std::vector<net::PageId>> below_;  // per page
  Numbered<net::SubsystemId, std::vector<net::ChannelId>>
      channels_;  // per subsystem: those that begin or end there
};

}  // namespace tessera::layers
