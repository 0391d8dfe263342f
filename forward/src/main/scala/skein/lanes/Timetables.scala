package skein.lanes

/** The timetables used last, for all threads.
  *
  * @param mostBytes that they hold, about
  */
private[lanes] final class Timetables(mostBytes: Long):
  private val known = java.util.LinkedHashMap[Any, Timetable](16, 0.75f, true)
  private var bytes = 0L

  /** Two threads may make the same at once; they make it equal.
    *
    * @param of all that it depends on
    */
  def getOrMake(of: Any)(make: => Timetable): Timetable =
    val held = known.synchronized(known.get(of))
    if held != null then held
    else
      val made = make
      known.synchronized:
        val before = known.put(of, made)
        bytes += made.bytes - (if before == null then 0 else before.bytes)
        val eldest = known.values.iterator
        while bytes > mostBytes && known.size > 1 do
          bytes -= eldest.next().bytes
          eldest.remove()
      made
