package skein.rpc

/** Error texts of rpclib, AirSim's RPC library. */
private[skein] object Rpclib:
  def unknown(method: String, arguments: Int): String =
    s"rpclib: server could not find function '$method' with argument count $arguments."

  /** The text for a wrong number of arguments. rpclib swaps the two numbers, and so does this. */
  def arity(method: String, passed: Int, wanted: Int): String =
    s"rpclib: client error C0002: Function '$method' was called with an invalid number of arguments. " +
      s"Expected: $passed, got: $wanted"

  def threw(method: String, arguments: Int, text: String): String =
    s"rpclib: function '$method' (called with $arguments arg(s)) threw an exception. " +
      s"The exception contained this information: $text."

  /** The text of the exception in an error of a function that threw. */
  def information(error: String): Option[String] = error match
    case Threw(text) => Some(text)
    case _           => None

  private val Threw =
    raw"(?s)rpclib: function .* threw an exception\. The exception contained this information: (.*)\.".r
