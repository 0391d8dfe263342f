package skein.mavlink

import scala.util.Random

/** Any message, by what its fields can hold. */
private object RandomMessage:
  def draw(random: Random): Message = draw(Dialect.all(random.nextInt(Dialect.all.size)), random)

  /** Any payload is one message. */
  def draw[A <: Message](definition: Definition[A], random: Random): A =
    val zeros = random.nextInt(definition.length + 1)
    definition.decode(Array.tabulate(definition.length)(index =>
      // Small bytes are text too, and the floats that they make are numbers.
      if index < zeros then random.nextInt(0x7f).toByte else 0
    ))
