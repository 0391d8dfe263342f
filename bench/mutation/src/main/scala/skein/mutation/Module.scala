package skein.mutation

/** Which tests are to notice a change in which sources.
  *
  * @param sources
  *   folder, below the repository
  * @param suites
  *   tried in this order until one fails
  */
final case class Module(name: String, sources: String, suites: Vector[String]):
  /** Whether a folder holds the classes of the sources; any may where those are anywhere. */
  def compilesTo(folder: String): Boolean =
    sources.isEmpty ||
      (folder.contains(s"/${sources.takeWhile(_ != '/')}/target/") && !folder.contains("test-classes"))
