#include "json_lines.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>

#include "quell/text/json.h"

namespace quell::app {
std::string utc_time() {
  using namespace std::chrono;
  const auto now = floor<milliseconds>(system_clock::now());
  const std::time_t seconds = system_clock::to_time_t(floor<std::chrono::seconds>(now));
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> date{}, fraction{};
  std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &utc);
  std::snprintf(fraction.data(), fraction.size(), ".%03dZ", static_cast<int>(now.time_since_epoch().count() % 1000));
  return std::string(date.data()) + fraction.data();
}

JsonObject& JsonObject::raw(std::string_view key, std::string_view json) {
  if (!members_.empty()) members_ += ',';
  members_.append(quote_json(key)).append(":").append(json);
  return *this;
}

JsonObject& JsonObject::text(std::string_view key, std::string_view value) { return raw(key, quote_json(value)); }

JsonObject& JsonObject::texts(std::string_view key, const std::vector<std::string>& values) {
  std::string list;
  for (const std::string& value : values) list += (list.empty() ? "" : ",") + quote_json(value);
  return raw(key, "[" + list + "]");
}

JsonObject& JsonObject::flag(std::string_view key, bool value) { return raw(key, value ? "true" : "false"); }

JsonObject& JsonObject::seconds(std::string_view key, double value) {
  std::array<char, 400> text{};  // room for the largest double
  std::snprintf(text.data(), text.size(), "%.6f", value);
  return raw(key, std::isfinite(value) ? text.data() : "null");
}

JsonObject& JsonObject::value(std::string_view key, double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return raw(key, std::isfinite(value) ? text.data() : "null");
}

JsonObject& JsonObject::object(std::string_view key, const JsonObject& value) { return raw(key, value.str()); }

JsonObject& JsonObject::objects(std::string_view key, const std::vector<JsonObject>& values) {
  std::string list;
  for (const JsonObject& value : values) list += (list.empty() ? "" : ",") + value.str();
  return raw(key, "[" + list + "]");
}

JsonLines::JsonLines(const std::filesystem::path& file, const char* option) : stream_(file, std::ios::binary) {
  if (!stream_) throw Error(Fault::usage, option, file.string() + " cannot be written: " + std::strerror(errno));
}

void JsonLines::write(std::string_view event, const JsonObject& members) {
  const std::scoped_lock lock(mutex_);  // also for the time, so that lines stand in its order
  const std::string line = JsonObject().text("event", event).text("time", utc_time()).members() +
                           (members.members().empty() ? "" : "," + members.members());
  stream_ << "{" << line << "}" << std::endl;
  if (!stream_) failed_ = true;
}

}  // namespace quell::app
