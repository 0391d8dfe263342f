package skein.lanes.gpu

import skein.gpu.Ptx
import skein.lanes.timetable.Timetable

/** The present operation of a [[GpuTimetable]] in a kernel: words that are equal for all threads of a block.
  *
  * @param base the register of its address
  * @param views the register of the views' address
  */
private[lanes] final class GpuRecord(code: Ptx, base: Int, views: Int):
  /** A field of the operation, from 1 on. */
  def field(number: Int): Int = code.loadWhole(base, number)

  /** Address in own memory of one of the operation's places. */
  def place(number: Int): Int = code.own(field(number))

  /** One of the operation's times; see [[Timetable.times]]. */
  def time(number: Int): Int = code.load(base, Timetable.Fields + number)

  /** By vehicle, the address in own memory of its reading in the operation's view. */
  def seen(): Int => Int =
    val view  = code.address(views, field(1))
    val known = collection.mutable.HashMap.empty[Int, Int]
    vehicle => known.getOrElseUpdate(vehicle, code.own(code.loadWhole(view, vehicle)))
