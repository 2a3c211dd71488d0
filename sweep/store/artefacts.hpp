// Keyed files beside the database: shared starting states and checkpoints. Written aside, synced, renamed,
// checksummed: half a file is never seen, a damaged one is as good as absent.
#pragma once

#include "solver/scenes/scene.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace grainsweep::store {

/// Files named by the hash of their key in one folder (created at the first put). Any number of processes may
/// use one folder at once. What a full or failing disk does throws BrokenWorld; get() never throws for it.
class ArtefactFolder final : public Artefacts {
public:
    explicit ArtefactFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
    [[nodiscard]] std::optional<Bytes> get(std::string_view key) override;
    void put(std::string_view key, std::span<const std::byte> contents) override;
    void remove(std::string_view key);

private:
    std::filesystem::path folder_;
    bool swept_ = false;  ///< leftovers of killed writers looked for
};

}  // namespace grainsweep::store
