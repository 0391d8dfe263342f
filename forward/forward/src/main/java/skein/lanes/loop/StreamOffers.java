package skein.lanes.loop;

import skein.forward.LoopTiming;
import skein.forward.TabledDelays;

/** The views of the {@code stream} loop, offered to all vehicles simultaneously. */
final class StreamOffers extends LaneOffers {
  private final LaneViews regular;
  private final JoinedViews joined;

  /** Whether {@link LaneViews} computes the views: over steady links, where nearly all are regular; and where
   * delays are equal, because only the scalar loop orders all events of one moment.
   */
  private boolean isRegular;

  private final boolean shortCut;
  private boolean isFirst;

  /** @param maxDelayS the longest one-way delay of any link */
  StreamOffers(
      LoopTiming.Stream timing,
      int vehicles,
      double durationS,
      double maxDelayS,
      boolean shortCut,
      MissingReadings missing) {
    this(
        timing,
        maxDelayS,
        new LaneViews(timing, vehicles, durationS, maxDelayS, shortCut, missing),
        shortCut);
  }

  private StreamOffers(LoopTiming.Stream timing, double maxDelayS, LaneViews regular, boolean shortCut) {
    super(regular.vehicles, regular.delays, regular.missing, true, LaneViews.ROWS_EARLY);
    this.regular = regular;
    this.shortCut = shortCut;
    joined = new JoinedViews(timing, vehicles, maxDelayS, delays, missing);
  }

  @Override
  void start(int[] worldKeys, TabledDelays[] links) {
    delays.start(worldKeys, links);
    isRegular = delays.isSteady && !missing.areSome || delays.isConstant || !shortCut;
    if (isRegular) regular.start(worldKeys, links);
    else joined.start(links);
  }

  @Override
  void startRow(int row) {
    if (isRegular) regular.startRow(row);
    else joined.startRow(row);
    isFirst = true;
  }

  @Override
  boolean nextBeat() {
    if (!isRegular) return nextJoined();
    if (!isFirst && !regular.nextBeat()) return false;
    isFirst = false;
    joinedAt = regular.joinedAt;
    nextAt = regular.nextAt;
    for (int v = 0; v < vehicles; v++) {
      sampledAt[v] = regular.sampledAt[v];
      fresh[v] = regular.hasOld ? regular.isFresh[v] : null;
      place[v] = regular.place[v];
    }
    return true;
  }

  private boolean nextJoined() {
    if (!joined.nextBeat()) return false;
    joinedAt = joined.round.joinedAt;
    nextAt = joined.nextAt;
    for (int v = 0; v < vehicles; v++) {
      sampledAt[v] = joined.round.sampledAt[v];
      fresh[v] = joined.round.isFresh[v];
      place[v] = joined.round.place[v];
    }
    return true;
  }
}
