package skein.lanes.timetable

import java.util.SplittableRandom
import scala.collection.mutable

/** A cache of timetables, shared by all threads. A search simulates its episodes repeatedly in one order. If
  * they do not all fit, evicting the oldest would always evict the next to be used, so a random one is
  * evicted.
  *
  * @param mostBytes approximate limit of the total size
  */
private[lanes] final class Timetables(mostBytes: Long = Timetables.MostBytes):
  private val known  = mutable.HashMap.empty[Any, Timetable]
  private val kept   = mutable.ArrayBuffer.empty[Any]
  private val random = SplittableRandom(1)
  private var bytes  = 0L

  /** The timetable of a key. Two threads may create it simultaneously, with equal results.
    *
    * @param of everything on which the timetable depends
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
  /** Maximum size of the cache, bytes: one minute of one vehicle takes some 100 kB, one minute of a team of
    * twenty that predicts takes 40 MB.
    */
  private val MostBytes = (256L << 20).max(Runtime.getRuntime.maxMemory / 8)
