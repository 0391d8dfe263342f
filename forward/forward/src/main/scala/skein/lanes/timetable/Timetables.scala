package skein.lanes.timetable

import java.util.SplittableRandom
import scala.collection.mutable

/** Timetables that were made, for all threads. A search flies the same episodes again and again, one after
  * the other: where there are more than have room, the oldest would go just before it is wanted. So any goes.
  *
  * @param mostBytes that they hold, about
  */
private[lanes] final class Timetables(mostBytes: Long = Timetables.MostBytes):
  private val known  = mutable.HashMap.empty[Any, Timetable]
  private val kept   = mutable.ArrayBuffer.empty[Any]
  private val random = SplittableRandom(1)
  private var bytes  = 0L

  /** Two threads may make the same at once; they make it equal.
    *
    * @param of all that it depends on
    */
  def getOrMake(of: Any)(make: => Timetable): Timetable =
    known.synchronized(known.get(of)).getOrElse:
      val made = make
      known.synchronized:
        if !known.contains(of) then
          while bytes + made.bytes > mostBytes && kept.nonEmpty do drop(random.nextInt(kept.size))
          known(of) = made
          kept += of
          bytes += made.bytes
      made

  private def drop(place: Int): Unit =
    bytes -= known.remove(kept(place)).get.bytes
    kept(place) = kept.last
    kept.dropRightInPlace(1)

private[lanes] object Timetables:
  /** A minute of one vehicle is some 100 kB; of a team of twenty that predicts, 40 MB in all. */
  private val MostBytes = (256L << 20).max(Runtime.getRuntime.maxMemory / 8)
