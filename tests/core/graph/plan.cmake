# The plan's tests build their graphs by hand, so that they stand apart from the parser's.
quell_add_test(graph_plan_test SOURCES cycle_ratio_test.cpp plan_graphs.cpp plan_test.cpp plan_shapes_test.cpp
  plan_buffers_test.cpp plan_fusion_test.cpp plan_loops_test.cpp plan_random_test.cpp plan_print_test.cpp preroll_test.cpp LINK quell::core)
