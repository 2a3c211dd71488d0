// Keyed files beside the database: shared starting states and checkpoints. Written aside, synced, renamed,
// checksummed: half a file is never seen, a damaged one is named and as good as absent.
#pragma once

#include "solver/scenes/scene.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace grainsweep::files {

/// Files named by the hash of their key in one folder (created at the first put). Any number of processes may
/// use one folder at once. What a full or failing disk does throws BrokenWorld; get() never throws for it.
class ArtefactFolder final : public Artefacts {
public:
    /// `on_damage` gets a sentence for every file that is there and cannot be used.
    explicit ArtefactFolder(std::filesystem::path folder,
                            std::function<void(const std::string& sentence)> on_damage = {})
        : folder_(std::move(folder)), on_damage_(std::move(on_damage)) {}
    [[nodiscard]] std::optional<Bytes> get(std::string_view key) override;
    void put(std::string_view key, std::span<const std::byte> contents) override;
    void remove(std::string_view key);
    /// Removes what writers that are gone left half written, at once where that was a process of this host, after
    /// ten minutes elsewhere; and files of whose key `over` is true. Call it with the writer's lock of the database
    /// held.
    void sweep(const std::function<bool(std::string_view key)>& over) const;

private:
    [[nodiscard]] std::optional<Bytes> read(const std::filesystem::path& file, std::string_view key,
                                            std::string& damage) const;

    std::filesystem::path folder_;
    std::function<void(const std::string&)> on_damage_;
    bool swept_ = false;  ///< leftovers of killed writers looked for
};

}  // namespace grainsweep::files
