package skein.lanes;

import skein.forward.DelayTable;
import skein.forward.Delays;
import skein.forward.LoopTiming;
import skein.forward.Nanos;
import skein.signal.Stamped;

/**
 * The views of one world under the {@code stream} loop, one after the other, with
 * all that can happen to questions: overtaken, late, failed, held back by a full window. No view
 * depends on what is decided, so they can be told ahead. {@code StreamRun} is the reference; of
 * things that happen in the same nanosecond answers come first here.
 *
 * <p>{@link LaneViews} tells views in which nothing of this happens, many worlds at a time,
 * and asks here for the others.
 */
final class ViewSource {
  static final long NEVER = Long.MAX_VALUE;

  private final long periodNs, timeoutNs, patienceNs, endNs;
  private final int vehicles, window, ahead;

  /**
   * Questions kept of each vehicle: with one that takes long, those asked meanwhile, and as many for the one
   * told last, whose answer may have come as it was asked.
   */
  private final int ring;

  private int key;
  private DelayTable link;

  // Of each vehicle: the next tick, whether a question waits, how many were asked, how many of them
  // are under way, none older than which, the newest that was answered.
  private final int[] tick, asked, oldest, underWay, newest, told;
  private final boolean[] waits;

  // Of each vehicle's questions: when they end (NEVER: they have), whether with an answer, the tick
  // that they belong to, when they were sent and when they reach the vehicle.
  private final long[][] endsAt, sentAt, reachesAt;
  private final boolean[][] succeeds;
  private final int[][] tickOf;

  // Of each vehicle: the reading held.
  private final boolean[] known, renewed;
  private final long[] toldAt, validAt, receivedAt;
  private long patienceEnds;

  // The view told last: when, of which questions, asked at which ticks, which reached the vehicles
  // when; ns.
  long joinedAt;
  final int[] question;
  private final int[] askedAtTick;
  final long[] sampledAt;

  /** Whether the view before had another reading of the vehicle. */
  final boolean[] isFresh;

  /** Whether the view told last is that of its row's questions, and nothing older is left behind it. */
  boolean isRegular;

  /** The latest of the ticks at which the view's questions were asked, or that of the view before. */
  int row;

  /**
   * @param maxDelayS the longest one-way delay of any link
   * @param ahead rows within which the questions of a regular view are answered
   */
  ViewSource(LoopTiming.Stream timing, int vehicles, double durationS, double maxDelayS, int ahead) {
    this.vehicles = vehicles;
    this.ahead = ahead;
    window = timing.asking().window();
    double longestS = Math.min(timing.asking().timeoutS(), 2 * maxDelayS);
    ring = 2 * (int) Math.ceil(longestS / timing.periodS()) + window + 2;
    tick = new int[vehicles];
    asked = new int[vehicles];
    oldest = new int[vehicles];
    underWay = new int[vehicles];
    newest = new int[vehicles];
    told = new int[vehicles];
    waits = new boolean[vehicles];
    endsAt = new long[vehicles][ring];
    sentAt = new long[vehicles][ring];
    reachesAt = new long[vehicles][ring];
    succeeds = new boolean[vehicles][ring];
    tickOf = new int[vehicles][ring];
    known = new boolean[vehicles];
    renewed = new boolean[vehicles];
    toldAt = new long[vehicles];
    validAt = new long[vehicles];
    receivedAt = new long[vehicles];
    question = new int[vehicles];
    askedAtTick = new int[vehicles];
    sampledAt = new long[vehicles];
    isFresh = new boolean[vehicles];
    periodNs = Nanos.of(timing.periodS());
    timeoutNs = Nanos.of(timing.asking().timeoutS());
    patienceNs = Nanos.of(timing.patienceS());
    endNs = Nanos.of(durationS);
  }

  /** Begins at a question when all questions before are answered and joined, if there were any. */
  void begin(int worldKey, DelayTable worldLink, int first) {
    key = worldKey;
    link = worldLink;
    patienceEnds = NEVER;
    row = first - 1;
    isRegular = false;
    for (int v = 0; v < vehicles; v++) {
      tick[v] = first;
      asked[v] = first;
      oldest[v] = first;
      underWay[v] = 0;
      newest[v] = first - 1;
      told[v] = first - 1;
      toldAt[v] = Long.MIN_VALUE;
      waits[v] = false;
      known[v] = first > 0;
      renewed[v] = false;
      validAt[v] = Long.MIN_VALUE;
      receivedAt[v] = Long.MIN_VALUE;
      question[v] = first - 1;
      askedAtTick[v] = first - 1;
      java.util.Arrays.fill(endsAt[v], NEVER);
    }
  }

  /** Goes on to the next view; {@link #joinedAt} is {@link #NEVER} if the flight ends before. */
  void next() {
    boolean joined = false;
    while (!joined) {
      int vehicle = -1, number = -1;
      long end = NEVER;
      for (int v = 0; v < vehicles; v++)
        if (underWay[v] > 0)
          for (int q = oldest[v]; q < asked[v]; q++)
            if (endsAt[v][q % ring] < end) {
              end = endsAt[v][q % ring];
              vehicle = v;
              number = q;
            }
      int ticking = 0;
      for (int v = 1; v < vehicles; v++) if (tick[v] < tick[ticking]) ticking = v;
      long tickAt = tick[ticking] * periodNs;
      long now = Math.min(end, Math.min(patienceEnds, tickAt));
      if (now > endNs) {
        joinedAt = NEVER;
        row = Integer.MAX_VALUE;
        isRegular = false;
        return;
      }
      if (end == now) {
        endsAt[vehicle][number % ring] = NEVER;
        underWay[vehicle]--;
        while (oldest[vehicle] < asked[vehicle] && endsAt[vehicle][oldest[vehicle] % ring] == NEVER)
          oldest[vehicle]++;
        boolean answered =
            succeeds[vehicle][number % ring]
                && (number > newest[vehicle] || isLater(vehicle, number));
        ask(vehicle, now);
        if (answered) {
          newest[vehicle] = Math.max(newest[vehicle], number);
          told[vehicle] = number;
          toldAt[vehicle] = now;
          joined = seen(vehicle, number, now);
        }
      } else if (patienceEnds == now) {
        joined = true;
      } else {
        tick[ticking]++;
        waits[ticking] = true;
        ask(ticking, now);
      }
      if (joined) join(now);
    }
  }

  private void ask(int vehicle, long now) {
    if (waits[vehicle] && underWay[vehicle] < window) {
      int number = asked[vehicle], at = number % ring;
      waits[vehicle] = false;
      underWay[vehicle]++;
      asked[vehicle]++;
      tickOf[vehicle][at] = tick[vehicle] - 1;
      sentAt[vehicle][at] = now;
      long there = link.delayNs(key, Delays.question(0, vehicle), number, number, now);
      long back = link.delayNs(key, Delays.answer(0, vehicle), number, number, now);
      reachesAt[vehicle][at] = now + there;
      succeeds[vehicle][at] = there <= timeoutNs && there + back <= timeoutNs;
      endsAt[vehicle][at] = now + (succeeds[vehicle][at] ? there + back : timeoutNs);
    }
  }

  /**
   * Whether an answer tells of a later moment than the one told last: questions, too, overtake each other.
   */
  private boolean isLater(int vehicle, int number) {
    return isNewer(vehicle, number, reachesAt[vehicle][told[vehicle] % ring], toldAt[vehicle]);
  }

  private boolean isNewer(int vehicle, int number, long thanValidAt, long thanReceivedAt) {
    int at = number % ring;
    return Stamped.isNewer(reachesAt[vehicle][at], sentAt[vehicle][at], thanValidAt, thanReceivedAt);
  }

  private boolean seen(int vehicle, int number, long now) {
    int at = number % ring;
    if (known[vehicle] && !isNewer(vehicle, number, validAt[vehicle], receivedAt[vehicle])) return false;
    known[vehicle] = true;
    renewed[vehicle] = true;
    validAt[vehicle] = reachesAt[vehicle][at];
    receivedAt[vehicle] = now;
    question[vehicle] = number;
    askedAtTick[vehicle] = tickOf[vehicle][at];
    if (!all(known)) return false;
    if (all(renewed)) return true;
    if (patienceEnds == NEVER) patienceEnds = now + patienceNs;
    return false;
  }

  private static boolean all(boolean[] each) {
    for (boolean one : each) if (!one) return false;
    return true;
  }

  private void join(long now) {
    patienceEnds = NEVER;
    joinedAt = now;
    for (int at : askedAtTick) row = Math.max(row, at);
    isRegular = now < (row + ahead) * periodNs;
    for (int v = 0; v < vehicles; v++) {
      isFresh[v] = renewed[v];
      renewed[v] = false;
      sampledAt[v] = validAt[v];
      isRegular &=
          question[v] == row
              && askedAtTick[v] == row
              && newest[v] == row
              && told[v] == row
              && oldest[v] > row
              && !waits[v]
              && asked[v] == tick[v]
              && validAt[v] < (row + 1) * periodNs;
    }
  }
}
