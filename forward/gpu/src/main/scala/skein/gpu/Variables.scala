package skein.gpu

/** Floats of each thread that change while a kernel runs.
  *
  * @param initial values that [[start]] sets
  */
private[skein] final class Variables(code: Ptx, initial: Seq[Float]):
  private val registers = initial.map(_ => code.fresh()).toArray

  def apply(number: Int): Int = registers(number)

  def start(): Unit = for (value, i) <- initial.zipWithIndex do code.constant(value, registers(i))

  /** Assigns values to the first variables, all simultaneously: a new value may be the old value of another
    * variable.
    */
  def take(values: Seq[Int]): Unit =
    val kept = values.map: value =>
      if registers.contains(value) then
        val copy = code.fresh()
        code.move(value, copy)
        copy
      else value
    for (value, i) <- kept.zipWithIndex do code.move(value, registers(i))
