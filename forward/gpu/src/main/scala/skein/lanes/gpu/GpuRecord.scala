package skein.lanes.gpu

import skein.gpu.Ptx
import skein.lanes.timetable.Timetable

/** What a [[GpuTimetable]] tells of the present operation, in a kernel: words that are the same for all
  * threads of a block.
  *
  * @param base the register of its address
  * @param views the same of the views
  */
private[lanes] final class GpuRecord(code: Ptx, base: Int, views: Int):
  /** One of the operation's fields, from 1 on. */
  def field(number: Int): Int = code.loadWhole(base, number)

  /** Where in own memory one of the operation's things is. */
  def place(number: Int): Int = code.own(field(number))

  /** One of its times; see [[Timetable.times]]. */
  def time(number: Int): Int = code.load(base, Timetable.Fields + number)

  /** Where in own memory the operation's view has a vehicle's reading. */
  def seen(): Int => Int =
    val view  = code.address(views, field(1))
    val known = collection.mutable.HashMap.empty[Int, Int]
    vehicle => known.getOrElseUpdate(vehicle, code.own(code.loadWhole(view, vehicle)))
