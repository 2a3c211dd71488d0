#include "sweep/cli/written_campaign.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/files/whole_file.hpp"

#include <fstream>
#include <system_error>

namespace grainsweep::cli {

WrittenCampaign::WrittenCampaign(const std::filesystem::path& folder, const std::string& name, const std::string& text,
                                 std::string_view option)
    : path_(folder / (name + ".json")) {
    std::error_code error;
    if (const std::string found = files::whole_file(path_, error); error != std::errc::no_such_file_or_directory) {
        if (error || found != text)
            throw campaign::input_error(std::string(option), path_.string(),
                                        "a file of this name exists; a campaign file of this command would replace it");
        ours_ = false;
        return;
    }
    std::ofstream file(path_, std::ios::binary);
    file << text << std::flush;
    if (!file) throw campaign::input_error(std::string(option), path_.string(), "cannot be written in this folder");
}

WrittenCampaign::~WrittenCampaign() {
    std::error_code ignored;
    if (ours_) std::filesystem::remove(path_, ignored);
}

}  // namespace grainsweep::cli
