package skein.forward

import skein.simd.WorldRandom

/** How long each message of a flight is under way. A pure function of the world and the message, so that
  * neither the order of the questions nor a batch changes anything.
  */
trait Delays:

  /** The one-way delay of a message, ns. A message that shares its line with others comes out after them,
    * whatever its own delay; [[LoopTiming]] says which lines keep their order.
    *
    * @param worldKey of [[WorldRandom]]
    * @param line what it is and of which vehicle: see [[Delays.question]] and the others
    * @param step of the loop, to which it belongs
    * @param number counts the messages of the vehicle and kind, whoever asks; that of an answer is its
    *   question's or command's
    * @param sentAtNs since the flight's start
    */
  def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long

object Delays:
  /** Lines of two vehicles, and so places of the random sequence that belong to one step; the kernels use the
    * same. Each further pair of askers and vehicles has as many lines of its own.
    */
  val Lines = 16

  private val MostPairs = Engagement.Most / 2

  /** @param asker the vehicle that each asks for itself (`Futures`); 0 where one asks for all
    */
  def question(asker: Int, vehicle: Int): Int =
    Lines * (asker / 2 * MostPairs + vehicle / 2) + 4 * (asker % 2) + 2 * (vehicle % 2)
  def answer(asker: Int, vehicle: Int): Int = question(asker, vehicle) + 1

  def command(vehicle: Int): Int         = Lines * (vehicle / 2) + FirstCommand + 2 * (vehicle % 2)
  def acknowledgement(vehicle: Int): Int = command(vehicle) + 1

  private[skein] val FirstCommand = 8

  private[skein] def isCommand(line: Int): Boolean = line % Lines >= FirstCommand

  /** The vehicle that a line leads to. */
  private[skein] def vehicleOf(line: Int): Int =
    val ofPair = if isCommand(line) then (line % Lines - FirstCommand) / 2 else line % 4 / 2
    line / Lines % MostPairs * 2 + ofPair

  /** The key of the sequence that a line's delays come from; that of the first two vehicles is the world's
    * own.
    */
  private[skein] def keyOf(worldKey: Int, line: Int): Int =
    if line < Lines then worldKey else WorldRandom.key(worldKey, line / Lines, 0)

  /** A line that no message uses: how long a link stays busy or quiet. */
  private[skein] val Stretch = 12

/** The delays of one flight, as they were: whatever world flies meets these. A message that is not on record
  * never arrives.
  *
  * @param delaysNs by vehicle and kind (question, answer, command, acknowledgement), then by number;
  *   [[RecordedDelays.Lost]] where one did not arrive
  */
final class RecordedDelays(delaysNs: Vector[Vector[Array[Long]]]) extends Delays:
  import RecordedDelays.Lost

  def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long =
    val vehicle = Delays.vehicleOf(line)
    val kind    = (if Delays.isCommand(line) then 2 else 0) + line % 2
    val known   = delaysNs(vehicle)(kind)
    if number < known.length then known(number) else Lost

object RecordedDelays:
  /** Thirty years. */
  val Lost: Long = 1_000_000_000_000_000_000L
