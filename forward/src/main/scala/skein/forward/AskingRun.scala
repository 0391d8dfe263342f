package skein.forward

/** A loop that asks every vehicle periodically and goes by the newest reading of each. Mutable. */
private[skein] abstract class AskingRun(world: DuelWorld, periodS: Double, asking: Asking)
    extends LoopRun,
      PeriodicQuestions.Seen:

  private val questions =
    Array.tabulate(world.count)(PeriodicQuestions(world, _, Nanos.of(periodS), asking, this))

  /** Of the newest reading of each vehicle, ns. */
  protected val validAt, receivedAt = Array.ofDim[Long](world.count)

  /** Which vehicles have been seen. */
  protected val known = Array.ofDim[Boolean](world.count)

  def start(): Unit =
    java.util.Arrays.fill(known, false)
    questions.foreach(_.start())

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

  /** The answer to a question is newer than what was known of its vehicle. */
  protected def renewed(vehicle: Int, question: Int): Unit
