// A campaign file that a command writes, runs and removes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace grainsweep::cli {

/// NAME.json in a folder where the paths that it names hold, until this object ends. An equal file that is there stays.
class WrittenCampaign {
public:
    /// `option`: what the user asked for. Throws WrongQuestion where another file of that name is there, or none can be
    /// written.
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
