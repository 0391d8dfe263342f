package skein.lanes

import skein.simd.LaneFunction

/** A function of what a view shows, and of other numbers that stay where they are. */
private[lanes] final class ViewCall(bound: BoundFunction, lanes: Int => Option[(Int, Int)]):
  val call: LaneCall = LaneCall(bound)

  // The function's inputs that are read from views, with the vehicle and the field.
  private val (places, vehicles, fields) =
    bound.inputs.zipWithIndex
      .flatMap((input, place) => lanes(input).map((vehicle, field) => (place, vehicle, field)))
      .unzip3

  def look(all: Array[TimetableAgents], views: Array[Int], view: Int): Unit =
    var i = 0
    while i < places.length do
      val vehicle = vehicles(i)
      val body    = all(vehicle).vehicles
      val from    = fields(i) match
        case 0 => body.seenX
        case 1 => body.seenY
        case 2 => body.seenVx
        case _ => body.seenVy
      call.input(places(i), from, views(view + vehicle) * LaneFunction.COUNT)
      i += 1
