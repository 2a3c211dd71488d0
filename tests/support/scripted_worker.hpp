// A worker that misbehaves by a script: a shell that keeps the protocol of sweep/workers/message.hpp in a real worker's
// place.
#pragma once

#include "tests/support/process.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace grainsweep::tests {

/// A campaign "scripted" of the rehearsal scene whose workers run a script, in a folder of its own.
///
/// The script finds the command of the real worker in "$@", what a real one says of itself in $ready, and the functions
/// `say LINE`, `next` (waits for a case; ends where there is none), `begun`, `done_with OUTCOME SCALARS` and
/// `give_back`.
class ScriptedCampaign {
public:
    /// `more`: further members of the campaign file, `fixed` inputs among them.
    explicit ScriptedCampaign(const std::string& script, int cases = 3,
                              const nlohmann::json& more = nlohmann::json::object());

    [[nodiscard]] std::vector<std::string> command(const std::vector<std::string>& more = {}) const;
    [[nodiscard]] Ended run(const std::vector<std::string>& more = {}) const;
    [[nodiscard]] nlohmann::json query(const std::string& sql) const;
    /// Of the only row and column.
    [[nodiscard]] nlohmann::json ask(const std::string& sql) const;
    [[nodiscard]] const Folder& folder() const { return folder_; }

private:
    Folder folder_;
};

}  // namespace grainsweep::tests
