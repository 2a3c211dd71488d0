#include "sweep/campaign/campaign_files.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/keys.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <system_error>

namespace grainsweep::campaign {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_file_name = 1024;
constexpr std::size_t largest_kept = 512ULL << 20U;  // a value of SQLite holds 10^9 bytes
/// Keys below which no text is the name of a file that the campaign keeps.
constexpr auto elsewhere = std::to_array<std::string_view>(
    {notes_key, schema_key, "campaign", "scene", "program", "machine", "execution", "model", "where", "accuracy",
     "convergence", "name", "kind", "observable", "factor", "of", "common_random_numbers"});

std::vector<CampaignFile> file_at(const std::string& place, const std::string& name, const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > largest_kept) return {};
    const std::string contents = files::whole_file(path, error);
    if (error) throw input_error(place, name, fmt::format("the file cannot be read: {}", error.message()));
    return {{place, name, content_hash(contents), fs::absolute(path)}};
}

void collect_files(const Json& value, const std::string& place, const fs::path& folder, std::set<std::string>& seen,
                   std::vector<CampaignFile>& files) {
    if (value.is_array())
        for (std::size_t k = 0; k < value.size(); ++k) collect_files(value[k], path_of(place, k), folder, seen, files);
    if (value.is_object())
        for (const auto& [key, inner] : value.items())
            if (std::ranges::find(elsewhere, key) == elsewhere.end())
                collect_files(inner, path_of(place, key), folder, seen, files);
    if (!value.is_string()) return;
    const auto& name = value.get_ref<const std::string&>();
    if (name.empty() || name.size() > longest_file_name || !seen.insert(name).second) return;
    for (auto& file : file_at(place, name, folder / name)) files.push_back(std::move(file));
}

}  // namespace

std::vector<CampaignFile> files_beside(const Json& document, const fs::path& folder) {
    std::vector<CampaignFile> files;
    std::set<std::string> seen;
    collect_files(document, "$", folder, seen, files);
    return files;
}

void add_powder_files(const std::string& place, const Powder& powder, Campaign& campaign) {
    const auto add = [&](const char* key, const fs::path& path) {
        const auto name = path.lexically_relative(powder.file.parent_path()).string();
        for (auto& file : file_at(place + key, name, path)) campaign.files.push_back(std::move(file));
    };
    if (!powder.posterior.empty()) add(".posterior", powder.posterior);
    if (powder.sizes && !powder.sizes->file.empty()) add(".sizes.file", powder.sizes->file);
    if (powder.sizes && powder.sizes->file.empty()) {
        if (!powder.sizes->source.empty()) add(".sizes.file", powder.sizes->source);
        campaign.files.push_back({place + ".sizes", powder.sizes_name(), content_hash(powder.sizes->csv), {}});
    }
}

}  // namespace grainsweep::campaign
