import "./style.css";
import { readReport, type Report } from "./data";
import { showDrawings } from "./drawing";
import { Pictures } from "./pictures";
import { Pixels } from "./pixels";
import { showPlots, showTimes } from "./plots";
import { showProvenance } from "./provenance";
import { shadeDifference } from "./shade";
import { firstState, Store } from "./state";
import { Story } from "./story";
import { showFigures } from "./table";
import { passNames } from "./taps";
import { find } from "./text";
import { Viewer } from "./viewer";

function describe(report: Report): string {
  const image = report.packed[0];
  const frames = report.frames.length === 1 ? `frame ${report.frames[0]}` : `${report.frames.length} frames, ${report.frames[0]}–${report.frames.at(-1)}`;
  const kept = report.kept.length < report.frames.length ? `; images of ${report.kept.length} of them` : "";
  return `${report.sequence}: ${frames}${kept}${image ? `, ${image.width} × ${image.height} pixels` : ""}. Made by ${report.provenance.version}, ${report.provenance.made}.`;
}

function tellFailures(report: Report) {
  const failures = report.graphs.flatMap((graph) => graph.failed.map((text) => `${graph.label}: ${text}`));
  if (failures.length === 0) return;
  find("trouble").hidden = false;
  find("trouble").textContent = failures.join("; ");
}

function showImages(report: Report) {
  const store = new Store(report, firstState(report));
  const pictures = new Pictures(report);
  const viewer = new Viewer(store, pictures);
  const story = new Story(store, pictures);
  // For tests: when everything that was asked for is shown, or only drawn; and the weights of a filter.
  Object.assign(window, {
    reportReady: async () => {
      await story.ready();
      await viewer.ready();
    },
    reportDrawn: () => viewer.drawn(),
    reportWeights: story.weightsOf.bind(story),
    reportPasses: passNames,
    reportDifference: (a: number[], b: number[]) => {
      const gray = (values: number[]) =>
        new Pixels({ width: values.length, height: 1, channels: 3, format: "f32" }, Float32Array.from([...values, ...values, ...values]));
      const { data } = shadeDifference(gray(a), gray(b), 0)!;
      return a.map((_, i) => [...data.slice(4 * i, 4 * i + 3)]);
    },
    reportFlip: async (left: number, right: number, frame: number) => [...((await pictures.flipErrors(report.images[left]!, report.images[right]!, frame)) ?? [])],
  });
}

function start() {
  const report = readReport();
  find("title").textContent = report.title;
  find("about").textContent = describe(report);
  tellFailures(report);
  if (report.images.length > 0) showImages(report);
  else for (const id of ["viewer", "story"]) find(id).hidden = true;
  showFigures(report);
  showPlots(report);
  showTimes(report);
  showDrawings(report);
  showProvenance(report);
}

try {
  start();
} catch (error) {
  find("trouble").hidden = false;
  find("trouble").textContent = `This report cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
  throw error;
}
