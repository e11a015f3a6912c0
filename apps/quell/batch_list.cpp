#include "batch_list.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <map>
#include <tuple>

#include "batch_check.h"
#include "commands.h"
#include "quell/text/error.h"
#include "quell/text/json_write.h"

namespace quell::app {
namespace {

constexpr std::int64_t kVersion = 1;
constexpr std::string_view kShotMark = "{shot}";

/// An option of `quell run`, as a list has it.
struct Key {
  enum class Kind { text, texts, flag };
  std::string name;
  Kind kind = Kind::text;
};

/// Why a list has no say in an option; "" for those that it may state.
std::string why_not(std::string_view name) {
  const auto is_one_of = [&](std::initializer_list<std::string_view> names) {
    return std::ranges::find(names, name) != names.end();
  };
  if (is_one_of({"threads", "memory"}))
    return "the batch shares them out among the shots that run at a time; say it to quell batch, for all";
  if (is_one_of({"log-json", "report", "quiet", "verbose"}))
    return "the batch keeps a log and a report of each shot; say where to quell batch, with --logs";
  if (is_one_of({"watch", "dry-run"})) return "a batch runs every shot once; leave it out";
  return "";
}

/// Taken from the command itself, so that a list may hold what the command takes.
std::vector<Key> run_keys() {
  CLI::App program;
  const CLI::App& run = *add_run(program).options;
  std::vector<Key> keys;
  for (const CLI::Option* option : run.get_options()) {
    std::string name = option->get_positional() ? option->get_name(true) : option->get_lnames().front();
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (name == "help") continue;
    const bool is_flag = option->get_expected_max() == 0 || option->get_type_size() == 0;
    const bool is_list = option->get_items_expected_max() > 1;
    keys.push_back({name, is_flag ? Key::Kind::flag : is_list ? Key::Kind::texts : Key::Kind::text});
  }
  return keys;
}

std::string with_name(std::string text, const std::string& shot) {
  for (std::size_t at = 0; (at = text.find(kShotMark, at)) != std::string::npos; at += shot.size())
    text.replace(at, kShotMark.size(), shot);
  return text;
}

class Reader {
 public:
  explicit Reader(const SourceTextPtr& text) : text_(text), keys_(run_keys()) {}

  std::vector<Shot> read() {
    if (const std::optional<Json> root = parse_json(text_, errors_)) read_root(*root);
    refuse_to_share_files();
    BatchCheck check(errors_);
    for (const Shot& shot : shots_)
      if (shot.find("graph") && shot.find("out")) check.check(shot);
    errors_.throw_if_any();
    return std::move(shots_);
  }

 private:
  bool expect(const Json& value, Json::Kind kind, const std::string& what) {
    if (value.kind == kind) return true;
    errors_.error(value.where, what + " must be " + std::string(describe(kind)) + ", not " + excerpt(value));
    return false;
  }

  void read_root(const Json& root) {
    if (!expect(root, Json::Kind::object, "a list of shots")) return;
    const std::vector<std::string> known = {"quell_batch", "doc", "defaults", "shots"};
    for (const JsonMember& member : root.members)
      if (std::ranges::find(known, member.key) == known.end())
        errors_.error(member.where, "unknown key '" + member.key + "'" + did_you_mean(member.key, known) +
                                        "; known here: " + list_names(known, "and"));
    const Json* version = root.find("quell_batch");
    if (!version)
      errors_.error(root.where, "the key 'quell_batch' is missing; write \"quell_batch\": 1");
    else if (version->kind != Json::Kind::integer || version->integer != kVersion)
      errors_.error(version->where, "this version of quell reads lists with \"quell_batch\": 1, not " + excerpt(*version));
    static const Json kNothing = make_object();
    const Json* defaults = root.find("defaults");
    if (!defaults || !expect(*defaults, Json::Kind::object, "'defaults'")) defaults = &kNothing;
    check_keys(*defaults);
    const Json* shots = root.find("shots");
    if (!shots)
      errors_.error(root.where, "the key 'shots' is missing; write an object of shots by name");
    else if (expect(*shots, Json::Kind::object, "'shots'"))
      for (const JsonMember& shot : shots->members) read_shot(shot, *defaults);
    if (shots && shots->kind == Json::Kind::object && shots->members.empty())
      errors_.error(shots->where,
                    "there is no shot; write one such as \"sh010\": { \"sequence\": \"sh010\", \"out\": \"done\" }");
  }

  void check_keys(const Json& object) {
    std::vector<std::string> known;
    for (const Key& key : keys_) known.push_back(key.name);
    for (const JsonMember& member : object.members) {
      if (const std::string why = why_not(member.key); !why.empty())
        errors_.error(member.where, "'" + member.key + "' is not for a list: " + why);
      else if (std::ranges::find(known, member.key) == known.end())
        errors_.error(member.where, "quell run has no option '" + member.key + "'" + did_you_mean(member.key, known) +
                                        "; `quell run --help` lists them");
    }
  }

  void read_shot(const JsonMember& member, const Json& defaults) {
    check_name(member);
    if (!expect(member.value, Json::Kind::object, "the shot '" + member.key + "'")) return;
    check_keys(member.value);
    Shot shot{member.key, {}, member.where};
    for (const Key& key : keys_) {  // in one order, whatever the list's, so that the command stays the same
      const Json* value = member.value.find(key.name);
      if (!value) value = defaults.find(key.name);
      if (value && value->kind != Json::Kind::null && why_not(key.name).empty()) read_option(key, *value, shot);
    }
    for (const char* needed : {"graph", "out"})
      if (!shot.find(needed) && !is_stated(member.value, defaults, needed))
        errors_.error(member.where, "the shot '" + member.key + "' has no '" + needed + "', and neither have the defaults");
    shots_.push_back(std::move(shot));
  }

  /// Wrongly, perhaps, which is told already.
  static bool is_stated(const Json& shot, const Json& defaults, const char* key) {
    const Json* value = shot.find(key) ? shot.find(key) : defaults.find(key);
    return value && value->kind != Json::Kind::null;
  }

  void check_name(const JsonMember& shot) {
    constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
    constexpr std::size_t kLongest = 200;  // a file's name has at most 255 bytes, and endings follow
    const std::string& name = shot.key;
    const bool is_possible =
        !name.empty() && name.size() <= kLongest && name.front() != '.' && name.find_first_not_of(kAllowed) == std::string::npos;
    if (!is_possible)
      errors_.error(shot.where, "'" + name +
                                    "' cannot be the name of a shot, which is that of its log, too; write letters, digits, "
                                    "'_', '-' and '.', and no '.' at the start");
  }

  void read_option(const Key& key, const Json& value, Shot& shot) {
    ShotOption option{key.name, {}, value.where};
    if (key.kind == Key::Kind::flag) {
      if (!expect(value, Json::Kind::boolean, "'" + key.name + "'") || !value.boolean) return;
    } else if (key.kind == Key::Kind::texts && value.kind == Json::Kind::array) {
      for (const Json& element : value.elements) add_text(key, element, shot, option);
      if (option.values.empty()) return;
    } else if (!add_text(key, value, shot, option)) {
      return;
    }
    shot.options.push_back(std::move(option));
  }

  bool add_text(const Key& key, const Json& value, const Shot& shot, ShotOption& option) {
    if (value.kind == Json::Kind::string) {
      option.values.push_back(with_name(value.string, shot.name));
    } else if (value.is_number()) {
      std::string number = write_json(value);
      number.pop_back();  // the line feed
      option.values.push_back(number);
    } else {
      errors_.error(value.where, "'" + key.name + "' must be a text" +
                                     (key.kind == Key::Kind::texts ? ", or an array of texts" : " or a number") + ", not " +
                                     excerpt(value));
      return false;
    }
    return true;
  }

  /// Shots that run at a time must not write the same files.
  void refuse_to_share_files() {
    const auto text = [](const Shot& shot, const char* option) {
      const ShotOption* found = shot.find(option);
      return found ? found->values.front() : std::string();
    };
    std::map<std::tuple<std::filesystem::path, std::string, std::string>, const Shot*> places;
    for (const Shot& shot : shots_) {
      if (!shot.find("out")) continue;
      std::filesystem::path out = (std::filesystem::path(text(shot, "out")) / "").lexically_normal();
      const auto [other, is_new] = places.try_emplace({out, text(shot, "frames"), text(shot, "layers")}, &shot);
      if (!is_new)
        errors_.error(shot.find("out")->where,
                      "the shots '" + other->second->name + "' and '" + shot.name +
                          "' would write to the same place; in 'defaults', {shot} stands for the name of "
                          "each shot");
    }
    std::map<std::string, const Shot*> kept;
    for (const Shot& shot : shots_) {
      if (!shot.find("checkpoint")) continue;
      const auto [other, is_new] = kept.try_emplace(text(shot, "checkpoint"), &shot);
      if (!is_new)
        errors_.error(shot.find("checkpoint")->where, "the shots '" + other->second->name + "' and '" + shot.name +
                                                          "' would keep their checkpoints in one folder");
    }
  }

  SourceTextPtr text_;
  std::vector<Key> keys_;
  std::vector<Shot> shots_;
  Diagnostics errors_;
};

}  // namespace

const ShotOption* Shot::find(std::string_view option) const {
  const auto found = std::ranges::find(options, option, &ShotOption::name);
  return found == options.end() ? nullptr : &*found;
}

std::vector<Shot> read_batch(const SourceTextPtr& list) { return Reader(list).read(); }

std::vector<std::string> command_of(const std::vector<ShotOption>& options) {
  std::vector<std::string> words = {"run"};
  for (const char* argument : {"graph", "sequence"})
    for (const ShotOption& option : options)
      if (option.name == argument) words.push_back(option.values.front());
  for (const ShotOption& option : options) {
    if (option.name == "graph" || option.name == "sequence") continue;
    const std::string name = "--" + option.name;
    if (option.values.empty()) words.push_back(name);
    for (const std::string& value : option.values) {
      if (value.starts_with('-'))  // in a word of its own it would be taken for an option
        words.push_back(name + "=" + value);
      else
        words.insert(words.end(), {name, value});
    }
  }
  return words;
}

}  // namespace quell::app
