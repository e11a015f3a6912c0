#include <algorithm>
#include <utility>

#include "quell/plugin/registry.h"
#include "quell/testing/conformance_frames.h"
#include "quell/text/error.h"

namespace quell::conformance {
namespace {

const quell_port_desc& input_port(const PassTest& pass, std::string_view name) {
  const auto list = inputs(pass);
  return **std::ranges::find_if(list, [&](const quell_port_desc* port) { return port->name == name; });
}

}  // namespace

Violations check_description(const MakePass& make) {
  const PassTest pass = make();
  const quell_pass_desc& desc = pass.desc();
  Violations violations;
  if (std::string wrong = quell::check(desc); !wrong.empty()) violations.push_back(std::move(wrong));
  const auto documented = [&](const char* text_of, const std::string& what) {
    if (!text_of || !*text_of) violations.push_back(what + " is not documented");
  };
  documented(desc.summary, "the summary");
  documented(desc.source, "the source (paper and equations)");
  for (const quell_port_desc* port : inputs(pass)) documented(port->doc, std::string("input '") + port->name + "'");
  for (const quell_port_desc* port : outputs(pass)) documented(port->doc, std::string("output '") + port->name + "'");
  for (std::uint32_t i = 0; i < desc.param_count; ++i) {
    const quell_param_desc& param = *QUELL_AT(quell_param_desc, desc.params, i);
    documented(param.doc, std::string("parameter '") + param.name + "'");
    for (std::uint32_t e = 0; e < param.enum_count; ++e)
      documented(param.enum_docs ? param.enum_docs[e] : nullptr,
                 std::string("value '") + param.enum_values[e] + "' of '" + param.name + "'");
  }
  return violations;
}

Violations check_sizes(const MakePass& make) {
  Violations violations;
  for (const Size size : {Size{1, 1}, Size{1, 7}, Size{7, 1}, Size{3, 5}, Size{16, 2}, Size{17, 9}, Size{33, 8}, Size{65, 3}})
    contained(violations, text(size), [&] {
      PassTest pass = make();
      connect(pass, size);
      const Results all = run(pass.next_frame(0));
      expect_finite(all, size, violations);
      // An id that is not written may look like any other; with other memory it is another.
      expect_same(all, run(pass.fresh_memory(0x11).next_frame(0)), "when fresh memory holds something else, " + text(size),
                  violations);
    });
  return violations;
}

Violations check_in_place(const MakePass& make) {
  Violations violations;
  PassTest pass = make();
  connect(pass, kOddSize);
  const Results want = run(pass.next_frame(0));
  PassTest moving = make();
  moving.in_place();
  for (const quell_port_desc* output : outputs(pass)) {
    connect(moving, kOddSize);
    const std::string source = moving.in_place_of(output->name);
    if (source.empty()) continue;
    contained(violations, "in place", [&] {
      const void* memory = nullptr;
      connect_port(moving, input_port(moving, source), kOddSize, 0, 0, [&](const Item& item) {
        memory = item.image()->buffer().data();
        return item;
      });
      const Results got = run(moving.next_frame(0));
      expect_same(want, got, "when '" + std::string(output->name) + "' takes over the memory of '" + source + "'", violations);
      if (moving.output_item(output->name).image()->buffer().data() != memory)
        violations.push_back("'" + std::string(output->name) + "' could not take over the memory of '" + source + "'");
    });
  }
  return violations;
}

Violations check_strides(const MakePass& make) {
  Violations violations;
  contained(violations, "with other strides", [&] {
    PassTest pass = make();
    connect(pass, kOddSize);
    const Results want = run(pass.next_frame(0));
    for (const quell_port_desc* port : inputs(pass)) {
      connect(pass, kOddSize);
      connect_port(pass, *port, kOddSize, 0, 3);
      expect_same(want, run(pass.next_frame(0)),
                  std::string("when the rows and planes of '") + port->name + "' lie farther apart", violations);
    }
  });
  return violations;
}

Violations check_chunks(const MakePass& make) {
  Violations violations;
  contained(violations, "with other chunks", [&] {
    PassTest pass = make();
    connect(pass, kOddSize);
    const Results want = run(pass.next_frame(0));
    for (const int grain : {1, 3, 1 << 20}) {
      pass.grain(grain);
      expect_same(want, run(pass.next_frame(0)), "with chunks of " + std::to_string(grain) + " rows", violations);
    }
    pass.grain(0).threads(4);
    expect_same(want, run(pass.next_frame(0)), "with 4 threads", violations);
  });
  return violations;
}

Violations check_rows(const MakePass& make) {
  Violations violations;
  contained(violations, "row by row", [&] {
    PassTest pass = make();
    connect(pass, kOddSize);
    const Results want = run(pass.next_frame(0));
    for (const int rows : {1, 3, 8}) {
      pass.rows_at_a_time(rows);
      expect_same(want, run(pass.next_frame(0)), "when it runs on " + std::to_string(rows) + " rows at a time", violations);
    }
  });
  return violations;
}

Violations check_purity(const MakePass& make) {
  Violations violations;
  contained(violations, "when it runs again", [&] {
    PassTest pass = make();
    connect(pass, kOddSize, 0);
    const Results want = run(pass.next_frame(5));
    connect(pass, kOddSize, 3);
    run(pass.next_frame(6));
    connect(pass, kOddSize, 0);
    expect_same(want, run(pass.next_frame(5)), "when the same frame is computed again after another one", violations);
  });
  return violations;
}

Violations check_optional_inputs(const MakePass& make) {
  Violations violations;
  const auto try_without = [&](const std::vector<std::string>& absent, const std::string& when) {
    PassTest pass = make();
    connect(pass, kOddSize);
    for (const std::string& port : absent) pass.disconnect(port);
    try {
      expect_finite(run(pass), kOddSize, violations);
    } catch (const Error& error) {
      if (error.fault() != Fault::usage)
        violations.push_back("fails " + when + " instead of refusing before it runs: " + error.what());
    } catch (const std::exception& error) { violations.push_back("throws " + when + ": " + error.what()); }
  };
  std::vector<std::string> all;
  for (const quell_port_desc* port : inputs(make()))
    if (port->flags & QUELL_PORT_OPTIONAL) all.emplace_back(port->name);
  for (const std::string& port : all) try_without({port}, "without '" + port + "'");
  if (all.size() > 1) try_without(all, "without any optional input");
  return violations;
}

}  // namespace quell::conformance
