#include "passes/display/tonemap_ocio.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace quell {
namespace {

namespace ocio = OCIO_NAMESPACE;
using Names = std::vector<std::string>;

// The names of OpenColorIO's built-in transforms start with these; what follows is what the parameters take.
constexpr std::string_view kOutputPrefix = "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - ";
constexpr std::string_view kDisplayPrefix = "DISPLAY - CIE-XYZ-D65_to_";

// Returns `wanted`, or `standard` when it is empty. Throws when `names` lacks it.
std::string choose(const std::string& parameter, const std::string& wanted, const Names& names, const std::string& standard) {
  const std::string& name = wanted.empty() ? standard : wanted;
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  std::string list;
  for (const std::string& known : names) list += (list.empty() ? "'" : ", '") + known + "'";
  throw std::runtime_error(parameter + ": there is no '" + name + "'; there are " + (list.empty() ? "none" : list));
}

Names builtin_names(std::string_view prefix) {
  Names names;
  const auto registry = ocio::BuiltinTransformRegistry::Get();
  for (std::size_t i = 0; i < registry->getNumBuiltins(); ++i) {
    const std::string_view style = registry->getBuiltinStyle(i);
    if (style.starts_with(prefix)) names.emplace_back(style.substr(prefix.size()));
  }
  return names;
}

ocio::BuiltinTransformRcPtr builtin(const std::string& style, ocio::TransformDirection direction = ocio::TRANSFORM_DIR_FORWARD) {
  const auto transform = ocio::BuiltinTransform::Create();
  transform->setStyle(style.c_str());
  transform->setDirection(direction);
  return transform;
}

// Linear Rec.709, through ACEScg and ACES2065-1, to the CIE XYZ light that the display should emit, to its code values.
ocio::ConstProcessorRcPtr builtin_processor(const OcioView::Choice& choice) {
  if (!choice.colorspace.empty())
    throw std::runtime_error("ocio_colorspace: '" + choice.colorspace +
                             "' is a matter of ocio_config; without one the input is linear Rec.709");
  const auto chain = ocio::GroupTransform::Create();
  chain->appendTransform(builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE));
  chain->appendTransform(builtin("ACEScg_to_ACES2065-1"));
  chain->appendTransform(
      builtin(std::string(kOutputPrefix) + choose("ocio_view", choice.view, builtin_names(kOutputPrefix), "SDR-VIDEO_1.0")));
  chain->appendTransform(
      builtin(std::string(kDisplayPrefix) + choose("ocio_display", choice.display, builtin_names(kDisplayPrefix), "sRGB")));
  return ocio::Config::CreateRaw()->getProcessor(chain);
}

ocio::ConstConfigRcPtr read_config(const std::string& file) {
  try {
    const auto config = ocio::Config::CreateFromFile(file.c_str());
    config->validate();
    return config;
  } catch (const ocio::Exception& error) {
    throw std::runtime_error("ocio_config: '" + file + "' is not a configuration that OpenColorIO can use: " + error.what());
  }
}

std::string find_colorspace(const ocio::ConstConfigRcPtr& config, const std::string& wanted) {
  const std::string name = wanted.empty() ? ocio::ROLE_SCENE_LINEAR : wanted;
  if (config->getColorSpace(name.c_str())) return name;  // by role or alias, too
  Names names;
  for (int i = 0; i < config->getNumColorSpaces(); ++i) names.emplace_back(config->getColorSpaceNameByIndex(i));
  return choose("ocio_colorspace", name, names, "");
}

ocio::ConstProcessorRcPtr config_processor(const OcioView::Choice& choice) {
  const ocio::ConstConfigRcPtr config = read_config(choice.config);
  Names displays, views;
  for (int i = 0; i < config->getNumDisplays(); ++i) displays.emplace_back(config->getDisplay(i));
  const std::string display = choose("ocio_display", choice.display, displays, config->getDefaultDisplay());
  for (int i = 0; i < config->getNumViews(display.c_str()); ++i) views.emplace_back(config->getView(display.c_str(), i));
  const std::string view = choose("ocio_view", choice.view, views, config->getDefaultView(display.c_str()));

  const auto transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(find_colorspace(config, choice.colorspace).c_str());
  transform->setDisplay(display.c_str());
  transform->setView(view.c_str());
  return config->getProcessor(transform);
}

}  // namespace

struct OcioView::Processor {
  ocio::ConstCPUProcessorRcPtr cpu;
};

OcioView::OcioView(const Choice& choice) {
  const auto processor = choice.config.empty() ? builtin_processor(choice) : config_processor(choice);
  processor_ = std::make_unique<const Processor>(Processor{processor->getDefaultCPUProcessor()});
}

OcioView::~OcioView() = default;

void OcioView::apply(const FloatOutput& image, int y0, int y1) const {
  ocio::PlanarImageDesc rows(image.row(y0, 0), image.row(y0, 1), image.row(y0, 2), nullptr, image.width, y1 - y0,
                             ocio::BIT_DEPTH_F32, sizeof(float), image.row_stride * std::ptrdiff_t{sizeof(float)});
  processor_->cpu->apply(rows);
}

}  // namespace quell
