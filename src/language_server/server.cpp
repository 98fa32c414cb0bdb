#include "language_server/server.hpp"

#include <csignal>
#include <stdexcept>

#include "language_server/session.hpp"
#include "project/files/files.hpp"

namespace tessera::language_server {

int serve(const Options& options) {
  const std::string schema = project::content_of(options.schema);
  if (schema.empty()) throw std::runtime_error("cannot read " + options.schema.string());
  const language::Grammar grammar(schema);
  // An editor that is gone is noticed when it is read.
  std::signal(SIGPIPE, SIG_IGN);
  Connection connection(options.in, options.out);
  Session session(connection, grammar);
  while (const std::optional<Connection::Incoming> incoming = connection.read())
    if (const std::optional<int> ended = session.handle(*incoming)) return *ended;
  return 1;
}

}  // namespace tessera::language_server
