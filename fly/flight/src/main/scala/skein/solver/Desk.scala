package skein.solver

import skein.units.Instant

/** The solver's side of one flight's requests: decides which is next, and from which memory. Immutable.
  * Vehicles with joint decisions count as the first of them.
  *
  * Each vehicle has one decision in progress. Of the requests received meanwhile the newest waits; older
  * requests, and those received after a newer one, are skipped.
  *
  * @param overtaken number of skipped requests
  * @param repeated number of requests received more than once
  */
final case class Desk private (vehicles: Vector[Desk.Vehicle], overtaken: Long, repeated: Long):
  import Desk.*

  /** Adds a received request.
    *
    * @param at time of receipt, on the solver's clock
    */
  def offered(question: Question, at: Instant): Desk =
    val known = vehicles(question.vehicle)
    if question.number == known.newest then copy(repeated = repeated + 1)
    else if question.number < known.newest then copy(overtaken = overtaken + 1)
    else
      copy(
        overtaken = overtaken + known.waiting.size,
        vehicles = vehicles.updated(
          question.vehicle,
          known.copy(newest = question.number, waiting = Some(Waiting(question, at)))
        )
      )

  /** The next request for a vehicle, if none is in progress and one waits. */
  def taken(vehicle: Int): (Desk, Option[Waiting]) =
    val known = vehicles(vehicle)
    if known.isBusy then (this, None)
    else
      val next = known.copy(waiting = None, isBusy = known.waiting.isDefined)
      (copy(vehicles = vehicles.updated(vehicle, next)), known.waiting)

  /** The memory from which a request continues; absent if it is not, or no longer, stored. */
  def memory(question: Question, solver: Long): Option[Any] =
    question.remembered.filter(_.solver == solver).flatMap(used =>
      vehicles(question.vehicle).memories.get(used.question)
    )

  /** Marks a request as decided.
    *
    * @param held the policy's memory after it, if it succeeded
    */
  def done(question: Question, held: Option[Any]): Desk =
    val known = vehicles(question.vehicle)
    val from  = question.remembered.fold(-1L)(_.question)
    // No request continues from a memory older than the last used one.
    val kept  = known.memories.filter((number, _) => number >= from)
    val added = held.fold(kept)(now => kept.updated(question.number, now))
    val most  = added.keysIterator.filter(_ != from).toVector.sorted.takeRight(MostMemories).toSet
    copy(vehicles =
      vehicles.updated(
        question.vehicle,
        known.copy(isBusy = false, memories = added.filter((number, _) => number == from || most(number)))
      )
    )

object Desk:
  /** Maximum number of memories kept for answers that may or may not have been in time. */
  val MostMemories = 32

  def of(vehicles: Int): Desk = Desk(Vector.fill(vehicles)(Vehicle(-1, None, false, Map.empty)), 0, 0)

  /** A waiting request.
    *
    * @param takenAt time of receipt, on the solver's clock
    */
  final case class Waiting(question: Question, takenAt: Instant)

  /** The state of one vehicle's requests.
    *
    * @param newest number of the newest request received
    * @param memories the policy's memories, by the request after which they were valid
    */
  final case class Vehicle(newest: Long, waiting: Option[Waiting], isBusy: Boolean, memories: Map[Long, Any])
