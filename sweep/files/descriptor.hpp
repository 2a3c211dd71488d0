// Descriptors of the system: a file, a folder, an end of a pipe.
#pragma once

#include <filesystem>
#include <string_view>
#include <utility>

namespace grainsweep::files {

/// Descriptor, closed by the destructor.
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
    /// Closes it. Returns false with errno if written data may be lost.
    [[nodiscard]] bool close();

private:
    int number_ = -1;
};

/// Writes all bytes. Returns false with errno on failure.
[[nodiscard]] bool write_all(int descriptor, std::string_view bytes);

/// Syncs a folder, which makes a rename durable. Throws SystemError.
void sync_folder(const std::filesystem::path& folder);

}  // namespace grainsweep::files
