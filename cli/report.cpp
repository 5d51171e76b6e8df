#include "report.hpp"

#include <unistd.h>

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "options.hpp"

namespace burin::cli {
namespace {

using Json = nlohmann::ordered_json;

Json json_object(const std::vector<Field>& fields);

Json json_value(const Field& field) {
    struct Value {
        Json operator()(std::int64_t value) const { return value; }
        // JSON has no infinity and no NaN.
        Json operator()(double value) const { return std::isfinite(value) ? Json(value) : Json(nullptr); }
        Json operator()(bool value) const { return value; }
        Json operator()(const std::string& value) const { return value; }
        Json operator()(const std::vector<Field>& fields) const { return json_object(fields); }
    };
    return std::visit(Value{}, field.value);
}

Json json_object(const std::vector<Field>& fields) {
    Json object = Json::object();
    for (const Field& field : fields) object[field.key] = json_value(field);
    return object;
}

bool holds_fields(const Field& field) { return std::holds_alternative<std::vector<Field>>(field.value); }

std::string joined(const std::vector<Field>& fields);

std::string shown(const Field& field) {
    if (!field.text.empty()) return field.text;
    struct Show {
        std::string operator()(std::int64_t value) const { return std::to_string(value); }
        std::string operator()(double value) const { return number_text(value); }
        std::string operator()(bool value) const { return value ? "yes" : "no"; }
        std::string operator()(const std::string& value) const { return value; }
        std::string operator()(const std::vector<Field>& fields) const { return joined(fields); }
    };
    return std::visit(Show{}, field.value);
}

std::string format_text(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// "name 3, other 4" of a group's fields.
std::string joined(const std::vector<Field>& fields) {
    std::string text;
    for (const Field& field : fields) {
        if (field.label.empty()) continue;
        text += (text.empty() ? "" : ", ") + field.label + " " + shown(field);
    }
    return text;
}

std::string line_text(const std::string& label, const std::string& value) {
    std::string left = label;
    left.resize(std::max<std::size_t>(left.size() + 1, 18), ' ');
    return left + value + "\n";
}

// Rows as columns, each as wide as its widest text.
std::string table_text(const Rows& table) {
    std::string text = table.title.empty() ? "" : table.title + "\n";
    const auto in_column = [](const Field& field) { return !field.label.empty() && !holds_fields(field); };
    std::vector<std::size_t> widths;
    for (const auto& row : table.rows)
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths.resize(std::max(widths.size(), i + 1));
            if (in_column(row[i])) widths[i] = std::max(widths[i], shown(row[i]).size());
        }
    for (const auto& row : table.rows) {
        std::string line = " ";
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (!in_column(row[i])) continue;
            std::string cell = shown(row[i]);
            const bool last = std::none_of(row.begin() + static_cast<std::ptrdiff_t>(i) + 1, row.end(), in_column);
            cell.resize(std::max(cell.size(), last ? 0 : widths[i]), ' ');
            line += " " + cell;
        }
        text += line + "\n";
        for (const Field& field : row)
            if (!field.label.empty() && holds_fields(field)) text += line_text("    " + field.label, shown(field));
    }
    return text;
}

}  // namespace

std::string Report::as_text() const {
    std::string text;
    for (const Field& field : fields_)
        if (!field.label.empty()) text += line_text(field.label, shown(field));
    for (const Rows& rows : rows_)
        if (!rows.rows.empty()) text += table_text(rows);
    return text;
}

std::vector<std::pair<std::string, std::string>> Report::lines(const std::string& but) const {
    std::vector<std::pair<std::string, std::string>> shown_fields;
    for (const Field& field : fields_)
        if (!field.label.empty() && field.key != but) shown_fields.emplace_back(field.label, shown(field));
    return shown_fields;
}

std::string Report::as_json() const {
    Json json = json_object(fields_);
    for (const Rows& rows : rows_) {
        json[rows.key] = Json::array();
        for (const auto& row : rows.rows) json[rows.key].push_back(json_object(row));
    }
    // Names of files need not be UTF-8; what is not is replaced instead of thrown at.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Status Report::print(const Arguments& arguments) const {
    const bool json = arguments.text("--format") == "json";
    if (!json && arguments.flag("--quiet")) return Done{};
    const std::string text = json ? as_json() : as_text();
    // Whether it arrived shows only when the buffer is written.
    const bool taken = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (taken && std::fflush(stdout) == 0) return Done{};
    return Error{ErrorCode::io_failed, "standard output cannot be written"};
}

ExitCode print_answer(const Arguments& arguments, const Report& report, ExitCode answer) {
    const Status printed = report.print(arguments);
    return printed ? answer : fail(arguments, code_for_output(printed.error()), printed.error().message);
}

ProgressLine::ProgressLine(const Arguments& arguments)
    : shown_(isatty(STDERR_FILENO) != 0 && !arguments.flag("--quiet")) {}

ProgressLine::~ProgressLine() {
    if (shown_ && !stage_.empty()) std::fputc('\n', stderr);
}

void ProgressLine::update(std::string_view stage, double fraction) {
    if (!shown_) return;
    if (stage != stage_) {
        finish();
        stage_ = stage;
        percent_ = -1;
        begun_ = std::chrono::steady_clock::now();
    }
    const int percent = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * 100.0);
    if (percent == percent_) return;
    percent_ = percent;
    std::fprintf(stderr, "\r  %-12s %3d %%", stage_.c_str(), percent);
}

void ProgressLine::finish() {
    if (!shown_ || stage_.empty()) return;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begun_;
    std::fprintf(stderr, "\r  %-12s 100 %%  %.2f s\n", stage_.c_str(), seconds.count());
    stage_.clear();
}

std::string number_text(double value) { return format_text("%.4g", value); }

std::string bytes_text(std::uint64_t bytes) {
    constexpr std::uint64_t kFew = 10, kKiB = 1024, kMiB = 1024 * kKiB;
    if (bytes < kFew * kKiB) return std::to_string(bytes) + " bytes";
    const bool many = bytes >= kFew * kMiB;
    return format_text(many ? "%.1f MiB" : "%.1f KiB", static_cast<double>(bytes) / static_cast<double>(many ? kMiB : kKiB));
}

std::string explained_text(double share) { return format_text("%.4f", std::floor(share * 1e4) / 1e4); }

std::string percent_text(double share, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f %%", digits, share * 100.0);
    return text;
}

}  // namespace burin::cli
