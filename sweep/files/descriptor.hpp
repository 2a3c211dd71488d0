// What the system opens by number: a file, a folder, an end of a pipe.
#pragma once

#include <filesystem>
#include <string_view>
#include <utility>

namespace grainsweep::files {

/// Closed in the end.
class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() { (void)close(); }

    [[nodiscard]] bool is_open() const { return number_ >= 0; }
    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] int release() { return std::exchange(number_, -1); }
    /// False where it was open and what was written may be lost: errno says why.
    [[nodiscard]] bool close();

private:
    int number_ = -1;
};

/// Writes all of it. False where that fails: errno says why.
[[nodiscard]] bool write_all(int descriptor, std::string_view bytes);

/// A renamed file is on disk when its folder is. Throws BrokenWorld.
void sync_folder(const std::filesystem::path& folder);

}  // namespace grainsweep::files
