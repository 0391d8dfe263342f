package skein.solver

import skein.units.Instant

/** A solver's side of one flight's questions: which is decided next, and from which memory. Immutable.
  * Vehicles that are decided for together count as the first of them.
  *
  * Of each vehicle one question is decided at a time. Of those that come meanwhile the newest waits; the
  * others, and those that come behind a newer one, are left.
  *
  * @param overtaken questions that were left
  * @param repeated questions that came more than once
  */
final case class Desk private (vehicles: Vector[Desk.Vehicle], overtaken: Long, repeated: Long):
  import Desk.*

  /** A question has come.
    *
    * @param at on the solver's clock
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

  /** The question to be decided now for a vehicle, if nothing is being decided for it and one waits. */
  def taken(vehicle: Int): (Desk, Option[Waiting]) =
    val known = vehicles(vehicle)
    if known.isBusy then (this, None)
    else
      val next = known.copy(waiting = None, isBusy = known.waiting.isDefined)
      (copy(vehicles = vehicles.updated(vehicle, next)), known.waiting)

  /** What the policy remembers that a question goes on from; absent where that is not there (any more). */
  def memory(question: Question, solver: Long): Option[Any] =
    question.remembered.filter(_.solver == solver).flatMap(used =>
      vehicles(question.vehicle).memories.get(used.question)
    )

  /** A question was decided.
    *
    * @param held what the policy remembers since, if that went well
    */
  def done(question: Question, held: Option[Any]): Desk =
    val known = vehicles(question.vehicle)
    val from  = question.remembered.fold(-1L)(_.question)
    // Nobody goes on from what is older than what was used last.
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
  /** Of answers of which it is not known yet whether they came in time. */
  val MostMemories = 32

  def of(vehicles: Int): Desk = Desk(Vector.fill(vehicles)(Vehicle(-1, None, false, Map.empty)), 0, 0)

  /** @param takenAt when it came, on the solver's clock
    */
  final case class Waiting(question: Question, takenAt: Instant)

  /** @param newest number of the newest question that came
    * @param memories by the question that they were there after
    */
  final case class Vehicle(newest: Long, waiting: Option[Waiting], isBusy: Boolean, memories: Map[Long, Any])
