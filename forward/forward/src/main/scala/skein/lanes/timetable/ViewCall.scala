package skein.lanes.timetable

import skein.lanes.policy.LaneObservation
import skein.simd.{BoundFunction, LaneCall, LaneFunction}
import skein.units.eachBelow

/** A call of a function whose inputs are fields of a view, or are read from fixed arrays.
  *
  * @param lanes the vehicle and field of an input that is read from a view
  * @param parameters the function's parameters, read at each call
  */
private[lanes] final class ViewCall(
    bound: BoundFunction,
    lanes: Int => Option[(Int, Int)],
    parameters: Array[Float] = Array.emptyFloatArray
):
  val call: LaneCall = LaneCall(bound, parameters)

  // The function's inputs that are read from views, with the vehicle and the field.
  private val (places, vehicles, fields) =
    bound.inputs.zipWithIndex
      .flatMap((input, place) => lanes(input).map((vehicle, field) => (place, vehicle, field)))
      .unzip3

  /** Sets the array and offset of one field of a vehicle, for all further calls. */
  def show(vehicle: Int, field: Int, array: Array[Float], from: Int): Unit =
    for i <- places.indices if vehicles(i) == vehicle && fields(i) == field do
      call.input(places(i), array, from)

  /** Sets the array and offset of all fields of a vehicle, which are stored one after the other. */
  def show(vehicle: Int, array: Array[Float], from: Int): Unit =
    for field <- 0 until LaneObservation.IN_SPACE do
      show(vehicle, field, array, from + field * LaneFunction.COUNT)

  def look(all: Array[TimetableAgents], views: Array[Int], view: Int): Unit =
    eachBelow(places.length): i =>
      val vehicle = vehicles(i)
      call.input(places(i), all(vehicle).vehicles.seen(fields(i)), views(view + vehicle) * LaneFunction.COUNT)
