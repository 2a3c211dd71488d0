// One file per key: magic, length of the key, length of the contents, XXH3 128-bit of both, key, contents.
#include "sweep/files/artefacts.hpp"

#include "sweep/files/aside_file.hpp"
#include "sweep/files/descriptor.hpp"
#include "sweep/files/locked_files.hpp"
#include "sweep/files/system_error.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace grainsweep::files {

namespace {

constexpr std::array<char, 8> magic = {'g', 's', 'w', 'p', 'a', 'r', 't', '1'};

struct Header {
    std::array<char, 8> magic{};
    std::uint64_t key_length = 0;
    std::uint64_t length = 0;
    std::array<std::uint64_t, 2> checksum{};
};
static_assert(sizeof(Header) == 40 && std::is_trivially_copyable_v<Header>);

std::array<std::uint64_t, 2> artefact_checksum(std::string_view key, std::span<const std::byte> contents) {
    struct Free {
        void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
    };
    const std::unique_ptr<XXH3_state_t, Free> state(XXH3_createState());
    XXH3_128bits_reset(state.get());
    XXH3_128bits_update(state.get(), key.data(), key.size());
    XXH3_128bits_update(state.get(), contents.data(), contents.size());
    const auto hash = XXH3_128bits_digest(state.get());
    return {hash.low64, hash.high64};
}

std::filesystem::path file_of(const std::filesystem::path& folder, std::string_view key) {
    const auto hash = XXH3_128bits(key.data(), key.size());
    return folder / fmt::format("{:016x}{:016x}.artefact", hash.high64, hash.low64);
}

std::string_view bytes_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Returns the key that is written in a file.
std::optional<std::string> key_in(const std::filesystem::path& file) {
    constexpr std::uint64_t longest_key = 1U << 20U;
    if (file.extension() != ".artefact" || is_locked_file(file)) return std::nullopt;
    std::ifstream stream(file, std::ios::binary);
    Header header;
    if (!stream.read(reinterpret_cast<char*>(&header), sizeof header)) return std::nullopt;
    if (header.magic != magic || header.key_length > longest_key) return std::nullopt;
    std::string key(header.key_length, '\0');
    if (!stream.read(key.data(), static_cast<std::streamsize>(key.size()))) return std::nullopt;
    return key;
}

/// Removes files being written, or left so, of which `gone` (with how long ago they were last written to) is true.
template <class Gone>
void sweep_leftovers(const std::filesystem::path& folder, Gone&& gone) {
    const auto now = std::filesystem::file_time_type::clock::now();
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (entry.path().extension() != AsideFile::extension) continue;
        const auto written = entry.last_write_time(ignored);
        if (!ignored && gone(entry.path(), now - written)) std::filesystem::remove(entry.path(), ignored);
    }
}

}  // namespace

std::optional<Bytes> ArtefactFolder::read(const std::filesystem::path& file, std::string_view key,
                                          std::string& damage) const {
    std::error_code error;
    if (const auto status = std::filesystem::status(file, error);
        std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        damage = "it is no regular file";  // to open a named pipe waits for a writer
        return std::nullopt;
    }
    if (is_locked_file(file)) {
        damage = "it is the database";
        return std::nullopt;
    }
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) {
        if (std::filesystem::exists(std::filesystem::symlink_status(file, error))) damage = "it cannot be read";
        return std::nullopt;
    }
    const auto size = static_cast<std::uint64_t>(std::max<std::streamoff>(stream.tellg(), 0));
    stream.seekg(0);
    Header header;
    damage = "it is cut short";
    if (size < sizeof header || !stream.read(reinterpret_cast<char*>(&header), sizeof header)) return std::nullopt;
    damage = "it is no such file";
    if (header.magic != magic) return std::nullopt;
    damage = "it belongs to something else";
    if (header.key_length != key.size()) return std::nullopt;
    damage = "its length is not as written";
    const std::uint64_t rest = size - sizeof header;
    if (key.size() > rest || header.length != rest - key.size()) return std::nullopt;
    damage = "it cannot be read";
    std::string stored_key(key.size(), '\0');
    if (!stream.read(stored_key.data(), static_cast<std::streamsize>(stored_key.size()))) return std::nullopt;
    Bytes contents(header.length);
    if (!stream.read(reinterpret_cast<char*>(contents.data()), static_cast<std::streamsize>(contents.size())))
        return std::nullopt;
    damage = "its checksum does not fit its contents";
    if (stored_key != key || header.checksum != artefact_checksum(key, contents)) return std::nullopt;
    damage.clear();
    return contents;
}

std::optional<Bytes> ArtefactFolder::get(std::string_view key) {
    const auto file = file_of(folder_, key);
    std::string damage;
    std::optional<Bytes> contents;
    try {
        contents = read(file, key, damage);
    } catch (const std::bad_alloc&) {
        damage = "it is too large for this machine's memory";
    }
    if (!damage.empty() && on_damage_)
        on_damage_(fmt::format("'{}' is damaged: {}; it is not used, and what it held is computed anew", file.string(),
                               damage));
    return contents;
}

void ArtefactFolder::visit(const std::function<void(std::string_view key)>& each) const {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
        const auto key = entry.is_regular_file(ignored) ? key_in(entry.path()) : std::nullopt;
        if (key) each(*key);
    }
}

void ArtefactFolder::sweep(const std::function<bool(std::string_view key)>& over) const {
    sweep_leftovers(folder_, [](const std::filesystem::path& file, auto silent) {
        const auto running = AsideFile::writer_runs(file);
        return running ? !*running : silent > std::chrono::minutes(10);
    });
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
        const auto key = entry.is_regular_file(ignored) ? key_in(entry.path()) : std::nullopt;
        if (key && over(*key)) std::filesystem::remove(entry.path(), ignored);
    }
}

void ArtefactFolder::put(std::string_view key, std::span<const std::byte> contents) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder_, error)) {
        std::filesystem::create_directories(folder_, error);
        if (error) throw SystemError(fmt::format("folder '{}': cannot be made: {}", folder_.string(), error.message()));
        sync_folder(std::filesystem::absolute(folder_).parent_path());
    }
    if (!std::exchange(swept_, true))  // no file takes a day to write
        sweep_leftovers(folder_,
                        [](const std::filesystem::path&, auto silent) { return silent > std::chrono::hours(24); });
    const Header header{magic, key.size(), contents.size(), artefact_checksum(key, contents)};
    AsideFile aside(file_of(folder_, key));
    aside.write(bytes_of(std::as_bytes(std::span(&header, 1))));
    aside.write(key);
    aside.write(bytes_of(contents));
    aside.take_place();
    sync_folder(folder_);
}

void ArtefactFolder::remove(std::string_view key) {
    std::error_code error;
    std::filesystem::remove(file_of(folder_, key), error);
    if (error)
        throw SystemError(fmt::format("'{}': cannot be removed: {}", file_of(folder_, key).string(), error.message()));
}

}  // namespace grainsweep::files
