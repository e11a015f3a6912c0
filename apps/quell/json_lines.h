// JSON Lines: a file with one object a line, which another program may read while it grows.
#pragma once

#include <atomic>
#include <concepts>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace quell::app {

/// Now, as "2024-05-01T12:30:00.250Z".
std::string utc_time();

/// A JSON object, written member by member.
class JsonObject {
 public:
  JsonObject& text(std::string_view key, std::string_view value);
  JsonObject& texts(std::string_view key, const std::vector<std::string>& values);
  JsonObject& flag(std::string_view key, bool value);
  JsonObject& number(std::string_view key, std::integral auto value) { return raw(key, std::to_string(value)); }
  /// To the microsecond. What is not finite becomes null.
  JsonObject& seconds(std::string_view key, double value);
  /// To nine digits that matter. What is not finite becomes null.
  JsonObject& value(std::string_view key, double value);
  JsonObject& object(std::string_view key, const JsonObject& value);
  JsonObject& objects(std::string_view key, const std::vector<JsonObject>& values);

  /// "{...}"
  std::string str() const { return "{" + members_ + "}"; }
  /// The members without the braces.
  const std::string& members() const { return members_; }

 private:
  JsonObject& raw(std::string_view key, std::string_view json);
  std::string members_;
};

/// Thread-safe.
class JsonLines {
 public:
  /// Begins the file anew. Throws Error(usage) naming the option when it cannot be opened.
  JsonLines(const std::filesystem::path& file, const char* option);

  /// {"event": event, "time": "2024-05-01T12:30:00.250Z", ...}, at once in the file.
  void write(std::string_view event, const JsonObject& members);
  /// Whether all lines so far are in the file.
  bool ok() const { return !failed_; }

 private:
  std::mutex mutex_;
  std::ofstream stream_;
  std::atomic<bool> failed_ = false;
};

}  // namespace quell::app
