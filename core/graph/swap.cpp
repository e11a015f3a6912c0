// --swap: another pass for a node.
#include <algorithm>
#include <bit>
#include <map>

#include "quell/graph/connect.h"
#include "quell/graph/edits.h"
#include "quell/graph/types.h"

namespace quell::detail {
namespace {

std::vector<const quell_port_desc*> ports(const quell_port_desc* first, std::uint32_t count) {
  std::vector<const quell_port_desc*> all;
  for (std::uint32_t i = 0; i < count; ++i) all.push_back(QUELL_AT(quell_port_desc, first, i));
  return all;
}

const quell_port_desc* find(const std::vector<const quell_port_desc*>& ports, std::string_view name) {
  const auto found = std::ranges::find_if(ports, [&](const quell_port_desc* port) { return port->name == name; });
  return found == ports.end() ? nullptr : *found;
}

std::string join(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text.empty() ? "nothing" : text;
}

class Swap {
 public:
  Swap(Unfolded& graph, const EditedNode& edited, const quell_pass_desc& pass, const Position& option, Diagnostics& errors)
      : graph_(graph),
        scope_(*edited.scope),
        node_(*edited.node),
        leaf_(graph.leaves[static_cast<std::size_t>(edited.child->leaf)]),
        pass_(pass),
        option_(option),
        errors_(errors),
        inputs_(ports(pass.inputs, pass.input_count)),
        outputs_(ports(pass.outputs, pass.output_count)) {}

  std::vector<std::string> run() {
    Diagnostics ignored;  // what is wrong with the graph is told when it is connected for good
    connect(graph_, ignored);
    const std::size_t before = errors_.size();
    for (const WrittenPort& port : node_.in) check_input(port);
    require_inputs();
    Document& document = own_document(graph_, scope_);
    map_outputs(document);
    if (errors_.size() > before) return {};
    replace(document);
    return std::move(changes_);
  }

 private:
  void tell(const std::string& message) { errors_.error(option_, "the pass '" + std::string(pass_.id) + "' " + message); }

  // What arrives at an input of the pass that the file names.
  std::vector<std::optional<PortType>> arriving(std::string_view input) const {
    std::vector<std::optional<PortType>> types;
    for (std::uint32_t i = 0; i < leaf_.pass->input_count; ++i)
      if (leaf_.input(i).name == input)
        for (const Arrival& arrival : leaf_.inputs[i]) types.push_back(type_of(graph_, arrival));
    return types;
  }

  void check_input(const WrittenPort& port) {
    const std::string name = "input '" + port.name.text + "'";
    const quell_port_desc* desc = find(inputs_, port.name.text);
    if (!desc) {
      left_out_.push_back(port.name.text);
      return;
    }
    if (port.is_list && !(desc->flags & QUELL_PORT_ARRAY))
      return tell("takes one source as its " + name + "; '" + node_.name.text + "' has a list there");
    for (const std::optional<PortType>& type : arriving(port.name.text))
      if (type && !accepts(desc->types, *type))
        tell("takes " + quell::describe(Types{desc->types}) + " as its " + name + "; '" + node_.name.text + "' has " +
             std::string(quell::name(*type)) + " there");
  }

  std::vector<std::string> describe_sources() const {
    std::vector<std::string> all;
    for (const WrittenPort& port : node_.in) {
      const auto types = arriving(port.name.text);
      all.push_back("'" + port.name.text + "'" +
                    (types.empty() || !types[0] ? "" : " (" + std::string(quell::name(*types[0])) + ")"));
    }
    return all;
  }

  void require_inputs() {
    for (const quell_port_desc* desc : inputs_) {
      const auto is_it = [&](const WrittenPort& port) { return port.name.text == desc->name; };
      if (desc->flags & QUELL_PORT_OPTIONAL || std::ranges::any_of(node_.in, is_it)) continue;
      tell("needs an input '" + std::string(desc->name) + "' (" + quell::describe(Types{desc->types}) + "), for which '" +
           node_.name.text + "' has no source of that name; it has " + join(describe_sources()));
    }
  }

  // The type that an output of the new pass would have.
  std::optional<PortType> new_type(const quell_port_desc& output) const {
    if (output.same_as < 0) return static_cast<PortType>(std::countr_zero(output.types));
    const quell_port_desc& followed = *inputs_[static_cast<std::size_t>(output.same_as)];
    const auto types = arriving(followed.name);
    if (types.empty()) return static_cast<PortType>(std::countr_zero(followed.types));
    return types[0];
  }
  std::optional<PortType> old_type(std::string_view output) const {
    for (std::uint32_t i = 0; i < leaf_.pass->output_count; ++i)
      if (leaf_.output(i).name == output)
        return type_of(graph_, Endpoint{scope_.children.at(node_.name.text).leaf, static_cast<int>(i), 0});
    return std::nullopt;
  }

  // Another name for an output, where both passes have exactly one of its type.
  const quell_port_desc* counterpart(PortType type) const {
    const quell_port_desc* only = nullptr;
    for (const quell_port_desc* output : outputs_) {
      if (new_type(*output) != type) continue;
      if (only) return nullptr;
      only = output;
    }
    int before = 0;
    for (const quell_port_desc* output : ports(leaf_.pass->outputs, leaf_.pass->output_count))
      before += old_type(output->name) == type;
    return before == 1 ? only : nullptr;
  }

  void map_outputs(Document& document) {
    const auto known = ports(leaf_.pass->outputs, leaf_.pass->output_count);
    for_each_reader(document, node_.name.text, [&](const Reader& reader) {
      const OutputName source = *split_source(reader.from.text);
      if (find(outputs_, source.port) || !find(known, source.port)) return;  // a misspelt name is told later
      if (reader.node && reader.node->name.text == node_.name.text && !find(inputs_, reader.input)) return;  // left out
      const std::string port(source.port);
      const std::optional<PortType> type = old_type(port);
      if (const quell_port_desc* other = type ? counterpart(*type) : nullptr) {
        renamed_[port] = other->name;
        return;
      }
      std::vector<std::string> names;
      for (const quell_port_desc* output : outputs_) {
        const std::optional<PortType> would_be = new_type(*output);
        names.push_back("'" + std::string(output->name) + "'" +
                        (would_be ? " (" + std::string(quell::name(*would_be)) + ")" : ""));
      }
      tell("has no output '" + port + "'" + (type ? " (" + std::string(quell::name(*type)) + ")" : "") + ", which " +
           reader.label + " reads; it has " + join(names));
    });
  }

  void replace(Document& document) {
    for_each_reader(document, node_.name.text, [&](const Reader& reader) {
      const OutputName source = *split_source(reader.from.text);
      const auto other = renamed_.find(std::string(source.port));
      if (other != renamed_.end()) reader.from.text = std::string(source.node) + "." + other->second + std::string(source.item);
    });
    if (!left_out_.empty())
      changes_.push_back("the input" + std::string(left_out_.size() > 1 ? "s " : " ") + list_names(left_out_, "and") +
                         " of the file " + (left_out_.size() > 1 ? "are" : "is") + " left out");
    for (const auto& [before, after] : renamed_)
      changes_.push_back("its output '" + after + "' is read where the file says '" + before + "'");
    const auto written =
        std::ranges::find_if(document.nodes, [&](const WrittenNode& n) { return n.name.text == leaf_.written->name.text; });
    leaf_.swapped_from = leaf_.pass;
    leaf_.swapped_version = written->version.value_or(leaf_.pass->version);
    written->pass = Text{pass_.id, option_};
    written->version.reset();
    std::erase_if(written->in, [&](const WrittenPort& port) { return !find(inputs_, port.name.text); });
    leaf_.pass = &pass_;
    leaf_.params.assign(pass_.param_count, {});
    leaf_.inputs.assign(pass_.input_count, {});
  }

  Unfolded& graph_;
  Scope& scope_;
  const WrittenNode node_;  // as the file has it
  Leaf& leaf_;
  const quell_pass_desc& pass_;
  const Position option_;
  Diagnostics& errors_;
  const std::vector<const quell_port_desc*> inputs_, outputs_;  // of the new pass
  std::map<std::string, std::string> renamed_;                  // outputs
  std::vector<std::string> left_out_;                           // inputs of the file
  std::vector<std::string> changes_;
};

}  // namespace

std::vector<std::string> swap_pass(Unfolded& graph, const EditedNode& edited, const quell_pass_desc& pass, const Position& option,
                                   Diagnostics& errors) {
  return Swap(graph, edited, pass, option, errors).run();
}

}  // namespace quell::detail
