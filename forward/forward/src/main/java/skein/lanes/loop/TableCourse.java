package skein.lanes.loop;

import java.util.Arrays;
import java.util.function.ToIntFunction;
import skein.forward.DelayTable;
import skein.forward.TableStretch;

/** The sequence of delay tables of a world's link during a flight. Mutable. */
final class TableCourse {
  private final ToIntFunction<DelayTable> beginOf;

  private TableStretch stretch;

  // Of each stretch: the offset of its table, and its end, since the flight's start, in grains.
  private int[] tables = new int[4];

  private long[] ends = new long[4];
  private int count;

  /** Index of the stretch of the last requested time: successive times lie close together. */
  private int at;

  /** @param beginOf returns the offset of a table in {@link LaneDelays#delays} */
  TableCourse(ToIntFunction<DelayTable> beginOf) {
    this.beginOf = beginOf;
  }

  void start(TableStretch first) {
    stretch = first;
    count = 0;
    at = 0;
    know();
  }

  /** Offset of the table for a message sent at this time, in grains since the flight's start. */
  int tableAt(long sentAt) {
    while (sentAt >= ends[at]) {
      if (at + 1 == count) {
        stretch.next();
        know();
      }
      at++;
    }
    while (at > 0 && sentAt < ends[at - 1]) at--;
    return tables[at];
  }

  private void know() {
    if (count == ends.length) {
      ends = Arrays.copyOf(ends, 2 * count);
      tables = Arrays.copyOf(tables, 2 * count);
    }
    tables[count] = beginOf.applyAsInt(stretch.table());
    // Messages are sent at whole grains.
    ends[count++] = Math.ceilDiv(stretch.untilNs(), DelayTable.GrainNs());
  }
}
