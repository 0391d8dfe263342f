package skein.forward

import skein.simd.WorldRandom

/** The delay of each message of a flight. A pure function of the world and the message, independent of the
  * order of calls and of batching.
  */
trait Delays:

  /** The one-way delay of a message, ns. Some lines keep the order of their messages ([[LoopTiming]]): a
    * message then arrives no earlier than its predecessors, even if its own delay is shorter.
    *
    * @param worldKey the world's key of [[WorldRandom]]
    * @param line kind and vehicle of the message; see [[Delays.question]] and the following methods
    * @param step the loop's step to which the message belongs
    * @param number index among the messages of this kind and vehicle, from all senders; an answer has the
    *   index of its request or command
    * @param sentAtNs time of sending, ns since the flight's start
    */
  def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long

object Delays:
  /** Number of lines of one pair of vehicles, and of random numbers that a pair uses per step. The first pair
    * is vehicles 0 and 1; each further pair of senders and vehicles has equally many.
    */
  val Lines = 16

  private val MostPairs = Engagement.Most / 2

  /** The line of a request.
    *
    * @param asker the vehicle whose controller sends the requests (`Futures`); 0 if one controller sends all
    */
  def question(asker: Int, vehicle: Int): Int =
    Lines * (asker / 2 * MostPairs + vehicle / 2) + 4 * (asker % 2) + 2 * (vehicle % 2)
  def answer(asker: Int, vehicle: Int): Int = question(asker, vehicle) + 1

  def command(vehicle: Int): Int         = Lines * (vehicle / 2) + FirstCommand + 2 * (vehicle % 2)
  def acknowledgement(vehicle: Int): Int = command(vehicle) + 1

  /** The line of a request for an image; the image itself has the next one. */
  private[skein] def image(vehicle: Int): Int = FirstImage + question(0, vehicle)

  private val FirstImage = Lines * MostPairs * MostPairs

  private[skein] val FirstCommand = 8

  private[skein] def isCommand(line: Int): Boolean = line % Lines >= FirstCommand

  /** The vehicle that receives or sends a line's messages. */
  private[skein] def vehicleOf(line: Int): Int =
    val ofPair = if isCommand(line) then (line % Lines - FirstCommand) / 2 else line % 4 / 2
    line / Lines % MostPairs * 2 + ofPair

  /** The key of the random sequence of a line's delays. For the first two vehicles it is the world's key. */
  private[skein] def keyOf(worldKey: Int, line: Int): Int =
    if line < Lines then worldKey
    else if line < FirstImage then WorldRandom.key(worldKey, line / Lines, 0)
    else imageKey(worldKey, vehicleOf(line))

  /** The key of all random numbers of a vehicle's images. */
  private[skein] def imageKey(worldKey: Int, vehicle: Int): Int = WorldRandom.key(worldKey, Images, vehicle)

  private val Images = 0x65796573

  /** A line without messages: its random numbers are the durations of a link's busy and quiet stretches. */
  private[skein] val Stretch = 12

/** Recorded delays of one flight, used in every simulated world. A message without a record never arrives.
  *
  * @param delaysNs delays, ns, indexed by vehicle and kind (request, answer, command, acknowledgement), then
  *   by message; [[RecordedDelays.Lost]] if the message did not arrive
  */
final class RecordedDelays(delaysNs: Vector[Vector[Array[Long]]]) extends Delays:
  import RecordedDelays.Lost

  def delayNs(worldKey: Int, line: Int, step: Int, number: Int, sentAtNs: Long): Long =
    val vehicle = Delays.vehicleOf(line)
    val kind    = (if Delays.isCommand(line) then 2 else 0) + line % 2
    val known   = delaysNs(vehicle)(kind)
    if number < known.length then known(number) else Lost

object RecordedDelays:
  val Lost: Long = 1_000_000_000_000_000_000L
