package skein.lanes.loop;

import skein.forward.LoopTiming;
import skein.forward.TabledDelays;

/** The views of the {@code stream} loop, offered to all vehicles simultaneously. */
final class StreamOffers extends LaneOffers {
  private final LaneViews views;
  private boolean isFirst;

  /** @param maxDelayS the longest one-way delay of any link */
  StreamOffers(
      LoopTiming.Stream timing,
      int vehicles,
      double durationS,
      double maxDelayS,
      boolean shortCut,
      MissingReadings missing) {
    this(new LaneViews(timing, vehicles, durationS, maxDelayS, shortCut, missing));
  }

  private StreamOffers(LaneViews views) {
    super(views.vehicles, views.delays, views.missing, true, LaneViews.ROWS_EARLY);
    this.views = views;
  }

  @Override
  void start(int[] worldKeys, TabledDelays[] links) {
    views.start(worldKeys, links);
  }

  @Override
  void startRow(int row) {
    views.startRow(row);
    isFirst = true;
  }

  @Override
  boolean nextBeat() {
    if (!isFirst && !views.nextBeat()) return false;
    isFirst = false;
    joinedAt = views.joinedAt;
    nextAt = views.nextAt;
    for (int v = 0; v < vehicles; v++) {
      sampledAt[v] = views.sampledAt[v];
      fresh[v] = views.hasOld ? views.isFresh[v] : null;
      place[v] = views.place[v];
    }
    return true;
  }
}
