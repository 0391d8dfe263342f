package skein.mavlink

import scala.util.Random

/** Random messages over the full range of each field. */
private object RandomMessage:
  def draw(random: Random): Message = draw(Dialect.all(random.nextInt(Dialect.all.size)), random)

  /** Draws a message by decoding a random payload. */
  def draw[A <: Message](definition: Definition[A], random: Random): A =
    val zeros = random.nextInt(definition.length + 1)
    definition.decode(Array.tabulate(definition.length)(index =>
      // Small bytes are valid text, and the floats that they form are numbers.
      if index < zeros then random.nextInt(0x7f).toByte else 0
    ))
