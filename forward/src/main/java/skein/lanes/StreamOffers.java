package skein.lanes;

import skein.forward.DelayTable;
import skein.forward.LoopTiming;

/** The pictures of the {@code stream} loop, offered to both vehicles at once. */
final class StreamOffers extends LaneOffers {
  private final LanePictures pictures;
  private boolean isFirst;

  StreamOffers(LoopTiming.Stream timing, double durationS) {
    this(new LanePictures(timing, durationS, true));
  }

  private StreamOffers(LanePictures pictures) {
    super(pictures.delays);
    this.pictures = pictures;
  }

  @Override
  void start(int[] worldKeys, DelayTable[] links) {
    pictures.start(worldKeys, links);
  }

  @Override
  void startRow(int row) {
    pictures.startRow(row);
    isFirst = true;
  }

  @Override
  boolean nextBeat() {
    if (!isFirst && !pictures.nextBeat()) return false;
    isFirst = false;
    joinedAt = pictures.joinedAt;
    nextAt = pictures.nextAt;
    for (int v = 0; v < 2; v++) {
      sampledAt[v] = pictures.sampledAt[v];
      fresh[v] = pictures.hasOld ? pictures.isFresh[v] : null;
      place[v] = pictures.place[v];
    }
    return true;
  }
}
