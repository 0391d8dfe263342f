package skein.forward

/** Reads one vehicle once a period, as `skein.flow.Sense` does. If a request becomes due while the window is
  * full, it waits; a second one is missed. An answer that arrives after the answer to a later request is
  * dropped, unless it was sampled later or `asking.inOrder` is set.
  */
private[skein] final class PeriodicQuestions(
    world: RolloutWorld,
    vehicle: Int,
    periodNs: Long,
    asking: Asking,
    seen: PeriodicQuestions.Seen
):
  import RolloutWorld.Ring
  import PeriodicQuestions.*

  private val offsetNs = Nanos.of(asking.spreadS) * vehicle / world.count
  private val ends     = Array.ofDim[Byte](Ring)
  private var waits    = false
  private var asked    = 0
  private var underWay = 0
  private var newest   = -1
  private var told     = -1
  private var oldest   = 0

  /** Begins at a request. All earlier requests, if any, must have ended. */
  def begin(question: Int): Unit =
    waits = false; asked = question; underWay = 0; newest = question - 1; told = newest; oldest = question
    world.schedule(offsetNs + question * periodNs, RolloutWorld.Tick, vehicle, question)

  /** Whether the reading of `question` is the newest and the last delivered, all requests up to it have
    * ended, all later ones are unanswered, none waits, and the number sent is `asked`.
    */
  def isUpTo(question: Int, asked: Int): Boolean =
    newest == question && told == question && underWay == asked - 1 - question &&
      this.asked == asked && !waits

  def tick(number: Int): Unit =
    world.schedule(offsetNs + (number + 1) * periodNs, RolloutWorld.Tick, vehicle, number + 1)
    waits = true
    ask()

  def ended(question: Int, answered: Boolean): Unit =
    if asking.inOrder then
      ends(question % Ring) = if answered then HasAnswer else Failed
      while oldest < asked && ends(oldest % Ring) != Open do
        underWay -= 1
        oldest += 1
        if ends((oldest - 1) % Ring) == HasAnswer then seen.seen(vehicle, oldest - 1)
    else
      underWay -= 1
      if answered && (question > newest || isNewer(question)) then
        newest = newest.max(question)
        told = question
        seen.seen(vehicle, question)
    ask()

  /** Whether an answer was sampled later than the last delivered one. Requests may overtake one another too.
    */
  private def isNewer(question: Int): Boolean =
    val last = world.slot(vehicle, told)
    world.isNewer(world.slot(vehicle, question), world.validAtNs(last), world.receivedAtNs(last))

  private def ask(): Unit =
    if waits && underWay < asking.window then
      waits = false
      underWay += 1
      ends(asked % Ring) = Open
      val _ = world.ask(0, vehicle, asked)
      asked += 1

private[skein] object PeriodicQuestions:
  /** Receives the readings in the order in which they are delivered. */
  trait Seen:
    def seen(vehicle: Int, question: Int): Unit

  private val Open: Byte      = 0
  private val HasAnswer: Byte = 1
  private val Failed: Byte    = 2
