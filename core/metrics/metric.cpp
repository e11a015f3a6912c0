#include "quell/metrics/metric.h"
