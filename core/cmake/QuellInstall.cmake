# What `cmake --install` gives of core/: the libraries, the public headers, and the package for find_package(quell). All paths are
# relative, so that the prefix may be moved.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/quell)

install(TARGETS quell_sdk quell_core quell_sequence quell_metrics quell_testing EXPORT quellTargets)
install(EXPORT quellTargets NAMESPACE quell:: DESTINATION ${package_dir})

configure_package_config_file(${PROJECT_SOURCE_DIR}/core/cmake/quellConfig.cmake.in ${PROJECT_BINARY_DIR}/quellConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS QUELL_PASSES_DIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/quellConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/quellConfig.cmake ${PROJECT_BINARY_DIR}/quellConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/core/cmake/QuellPass.cmake DESTINATION ${package_dir})

# The public headers by name: what is not listed is private to its box.
set(public_headers
  simd/isa.h simd/vectors-inl.h
  sdk/abi.h sdk/types.h sdk/frame.h sdk/params.h sdk/pass.h sdk/plain_loop.h
  text/error.h text/diagnostic.h text/json.h text/json_write.h
  image/port_type.h image/buffer_pool.h image/image.h image/item.h image/stream.h
  plugin/registry.h plugin/pass_instance.h
  graph/graph.h graph/graph_hash.h graph/plan.h graph/plan_dot.h graph/preroll.h graph/schema.h graph/slowest_cycles.h
  runtime/analysis.h runtime/executor.h runtime/function_ref.h runtime/host.h runtime/rerun.h runtime/sanitize.h runtime/saved_history.h runtime/session.h
  runtime/thread_budget.h runtime/trace.h runtime/window.h
  sequence/sequence.h sequence/frame_range.h sequence/file_sink.h sequence/image_file.h sequence/image_input.h
  sequence/conventions.h sequence/item_file.h sequence/layers.h
  metrics/comparison.h metrics/display.h metrics/flip.h metrics/metric.h metrics/parallel.h
  testing/pass_test.h testing/conformance.h testing/conformance_checks.h testing/synthetic.h)
foreach(header IN LISTS public_headers)
  cmake_path(GET header PARENT_PATH box)
  install(FILES ${PROJECT_SOURCE_DIR}/core/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/quell/${box})
endforeach()
