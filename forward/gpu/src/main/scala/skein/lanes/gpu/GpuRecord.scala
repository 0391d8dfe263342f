package skein.lanes.gpu

import skein.gpu.Ptx
import skein.lanes.timetable.Timetable

/** The present operation of a [[GpuTimetable]] in a kernel. Its words are equal for all threads of a block.
  *
  * @param base register of the operation's address
  * @param views register of the views' address
  */
private[lanes] final class GpuRecord(code: Ptx, base: Int, views: Int):
  /** Register of a field of the operation, counted from 1. */
  def field(number: Int): Int = code.loadWhole(base, number)

  /** Address, in the thread's own memory, that a field of the operation states. */
  def place(number: Int): Int = code.own(field(number))

  /** Register of a time of the operation; see [[Timetable.times]]. */
  def time(number: Int): Int = code.load(base, Timetable.Fields + number)

  /** For each vehicle, the address of its reading in the operation's view, in the thread's own memory. */
  def seen(): Int => Int =
    val view  = code.address(views, field(1))
    val known = collection.mutable.HashMap.empty[Int, Int]
    vehicle => known.getOrElseUpdate(vehicle, code.own(code.loadWhole(view, vehicle)))
