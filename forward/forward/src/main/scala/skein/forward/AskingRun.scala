package skein.forward

/** A loop that reads every vehicle periodically and uses the newest reading of each. Mutable. */
private[skein] abstract class AskingRun(protected val world: RolloutWorld, periodS: Double, asking: Asking)
    extends LoopRun,
      PeriodicQuestions.Seen:

  protected val questions: Array[PeriodicQuestions] =
    Array.tabulate(world.count)(PeriodicQuestions(world, _, Nanos.of(periodS), asking, this))

  /** Sampling and arrival time of the newest reading of each vehicle, ns. */
  protected val validAt, receivedAt = Array.ofDim[Long](world.count)

  protected val known = Array.ofDim[Boolean](world.count)

  def start(): Unit = begin(0)

  /** Begins at a request. All earlier requests, if any, must have been answered and used. */
  protected def begin(question: Int): Unit =
    java.util.Arrays.fill(known, question > 0)
    java.util.Arrays.fill(validAt, Long.MinValue)
    java.util.Arrays.fill(receivedAt, Long.MinValue)
    questions.foreach(_.begin(question))

  final def tick(vehicle: Int, number: Int): Unit = questions(vehicle).tick(number)

  final def answered(vehicle: Int, question: Int): Unit = questions(vehicle).ended(question, answered = true)

  final def timedOut(vehicle: Int, question: Int): Unit = questions(vehicle).ended(question, answered = false)

  final def seen(vehicle: Int, question: Int): Unit =
    val at = world.slot(vehicle, question)
    if !known(vehicle) || world.isNewer(at, validAt(vehicle), receivedAt(vehicle)) then
      known(vehicle) = true
      validAt(vehicle) = world.validAtNs(at)
      receivedAt(vehicle) = world.receivedAtNs(at)
      renewed(vehicle, question)

  /** Called for an answer that is newer than the vehicle's previous reading. */
  protected def renewed(vehicle: Int, question: Int): Unit
