// Files with keys beside the database: shared starting states and checkpoints. Each is written to a temporary file,
// synced and renamed, with a checksum. So an incomplete file is never read; a damaged one is reported and ignored.
#pragma once

#include "solver/scenes/scene.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace grainsweep::files {

/// Folder of files named by the hash of their key; it is made at the first put(). Any number of processes may use it at
/// the same time. A full or failing disk throws SystemError, except in get().
class ArtefactFolder final : public Artefacts {
public:
    /// `on_damage`: called with a sentence on every unusable file.
    explicit ArtefactFolder(std::filesystem::path folder,
                            std::function<void(const std::string& sentence)> on_damage = {})
        : folder_(std::move(folder)), on_damage_(std::move(on_damage)) {}
    [[nodiscard]] std::optional<Bytes> get(std::string_view key) override;
    void put(std::string_view key, std::span<const std::byte> contents) override;
    void remove(std::string_view key);
    /// Calls `each` with the key of every file.
    void visit(const std::function<void(std::string_view key)>& each) const;
    /// Removes incomplete files of dead writers, at once for processes of this host, after ten minutes for other hosts.
    /// Also removes files for whose key `over` is true. The caller must have the writer's lock of the database.
    void sweep(const std::function<bool(std::string_view key)>& over) const;

private:
    [[nodiscard]] std::optional<Bytes> read(const std::filesystem::path& file, std::string_view key,
                                            std::string& damage) const;

    std::filesystem::path folder_;
    std::function<void(const std::string&)> on_damage_;
    bool swept_ = false;  ///< incomplete files have been removed
};

}  // namespace grainsweep::files
