// Campaign file that a command writes, runs and removes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace grainsweep::cli {

/// File NAME.json in a folder in which its paths are valid, during the lifetime of this object. An existing equal file
/// is kept.
class WrittenCampaign {
public:
    /// `option`: option of the user, for messages. Throws InputError if another file of this name exists, or none
    /// can be written.
    WrittenCampaign(const std::filesystem::path& folder, const std::string& name, const std::string& text,
                    std::string_view option);
    ~WrittenCampaign();
    WrittenCampaign(const WrittenCampaign&) = delete;
    WrittenCampaign& operator=(const WrittenCampaign&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    bool ours_ = true;
};

}  // namespace grainsweep::cli
