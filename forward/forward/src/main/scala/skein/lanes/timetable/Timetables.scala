package skein.lanes.timetable

import java.util.SplittableRandom
import scala.collection.mutable

/** A cache of timetables, for all threads. A search simulates its episodes again and again in order: where
  * they do not all fit, the oldest would be evicted just before its use, so the evicted one is arbitrary.
  *
  * @param mostBytes limit of their size, approximately
  */
private[lanes] final class Timetables(mostBytes: Long = Timetables.MostBytes):
  private val known  = mutable.HashMap.empty[Any, Timetable]
  private val kept   = mutable.ArrayBuffer.empty[Any]
  private val random = SplittableRandom(1)
  private var bytes  = 0L

  /** The timetable of a key. Two threads may make it simultaneously, with equal results.
    *
    * @param of everything on which it depends
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
  /** Limit of the cache: a minute of one vehicle is some 100 kB; of a team of twenty that predicts, 40 MB in
    * all.
    */
  private val MostBytes = (256L << 20).max(Runtime.getRuntime.maxMemory / 8)
