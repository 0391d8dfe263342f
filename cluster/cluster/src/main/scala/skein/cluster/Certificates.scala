package skein.cluster

import java.io.IOException
import java.net.InetAddress
import java.nio.file.attribute.PosixFilePermissions
import java.nio.file.StandardCopyOption.{COPY_ATTRIBUTES, REPLACE_EXISTING}
import java.nio.file.{FileSystems, Files, Path}
import java.security.{GeneralSecurityException, KeyStore, SecureRandom}
import java.util.HexFormat
import scala.util.{Try, Using}
import scala.util.control.NonFatal

/** Makes a lab's certificates with the JDK's own `keytool`: a signing key, and a folder for each host that
  * [[Tls.of]] reads.
  */
object Certificates:
  private val Days = 825

  /** The signing key's file: it stays on the machine that makes the certificates, and must not be copied to
    * another.
    */
  private val Signer = "signer.p12"

  /** A host's folder name; `*.workers.lab` stands for all hosts of that domain. */
  def folderOf(host: String): String = host.replace("*", "_")

  /** @param hosts the hosts' names or addresses, as in `--listen` and `--join`
    * @return Left says which of them is neither
    */
  def checked(hosts: Seq[String]): Either[String, Unit] =
    hosts.find(!isHost(_)).toLeft(()).left.map(host => s"expected a host's name or address, got '$host'")

  /** Makes the certificates. If a host is invalid or already has a certificate, it makes none.
    *
    * @param hosts the hosts' names or addresses, as in `--listen` and `--join`
    * @return each host's folder; Left says what went wrong
    */
  def make(folder: Path, hosts: Seq[String]): Either[String, Vector[Path]] =
    val had = hosts.map(host => folder.resolve(folderOf(host))).find(own =>
      Files.exists(own.resolve(Tls.KeyStore))
    )
    try
      for
        _ <- checked(hosts)
        _ <- had.toLeft(()).left.map(own => s"$own holds a certificate already")
        _ = Files.createDirectories(folder)
        _    <- if Files.exists(folder.resolve(Signer)) then Right(()) else sign(folder)
        made <- hosts.foldLeft[Either[String, Vector[Path]]](Right(Vector.empty)): (before, host) =>
          before.flatMap(all => node(folder, host).map(all :+ _))
      yield made
    catch
      case failed: IOException              => Left(s"cannot write into $folder: ${failed.getMessage}")
      case failed: GeneralSecurityException =>
        Left(s"cannot make certificates in $folder: ${failed.getMessage}")

  private def isHost(text: String) =
    if text.matches("[0-9.]+|.*:.*") then address(text).isDefined && !text.contains('%')
    else text.matches("""(\*\.)?[A-Za-z0-9][A-Za-z0-9.-]{0,252}""")

  private def address(text: String): Option[InetAddress] = Try(InetAddress.ofLiteral(text)).toOption

  private def sign(folder: Path): Either[String, Unit] =
    val secret = password(folder.resolve("signer.password"))
    for
      _ <- keytool(
        secret,
        folder.resolve(Signer),
        Seq(
          "-genkeypair",
          "-alias",
          "signer",
          "-dname",
          "CN=Skein lab",
          "-ext",
          "bc:c=ca:true,pathlen:0",
          "-ext",
          "ku:c=keyCertSign"
        ) ++ Key
      )
    yield onlyOurs(folder.resolve(Signer))

  private def node(folder: Path, host: String): Either[String, Path] =
    val own = folder.resolve(folderOf(host))
    Files.createDirectories(own)
    val secret          = password(own.resolve(Tls.Password))
    val (keys, trusted) = (own.resolve(Tls.KeyStore), own.resolve(Tls.TrustStore))
    val names           =
      if host == "localhost" then "dns:localhost,ip:127.0.0.1"
      else address(host).fold(s"dns:$host")(address => s"ip:${address.getHostAddress}")
    // One call makes and signs a key in the signer's store: in a copy, of which only the node's key is kept.
    val signing = Files.readString(folder.resolve("signer.password")).trim
    val both    =
      Files.copy(folder.resolve(Signer), own.resolve("both.p12"), COPY_ATTRIBUTES, REPLACE_EXISTING)
    try
      keytool(
        signing,
        both,
        Seq("-genkeypair", "-alias", "node", "-signer", "signer", "-dname", s"CN=$host") ++
          Seq(
            s"san=$names",
            "eku=serverAuth,clientAuth",
            "ku:c=digitalSignature"
          ).flatMap(Seq("-ext", _)) ++ Key
      ).map: _ =>
        val made = KeyStore.getInstance(both.toFile, signing.toCharArray)
        write(keys, secret)(_.setKeyEntry(
          "node",
          made.getKey("node", signing.toCharArray),
          secret.toCharArray,
          made.getCertificateChain("node")
        ))
        write(trusted, secret)(_.setCertificateEntry("signer", made.getCertificate("signer")))
        onlyOurs(keys)
        own
    finally Files.deleteIfExists(both): Unit

  private def write(to: Path, password: String)(entry: KeyStore => Unit): Unit =
    val store = KeyStore.getInstance("PKCS12")
    store.load(null, null)
    entry(store)
    Using.resource(Files.newOutputStream(to))(store.store(_, password.toCharArray))

  private val Key =
    Seq("-keyalg", "EC", "-groupname", "secp256r1", "-sigalg", "SHA256withECDSA", "-validity", Days.toString)

  /** JVM options for a run that is too short for optimisation to pay: they save a third of the processor
    * time.
    */
  private val Brief = Seq("-J-XX:TieredStopAtLevel=1", "-J-XX:+UseSerialGC")

  private def password(file: Path): String =
    val bytes = Array.ofDim[Byte](24)
    SecureRandom().nextBytes(bytes)
    val secret = HexFormat.of.formatHex(bytes)
    Files.writeString(file, secret)
    onlyOurs(file)
    secret

  private def onlyOurs(file: Path): Unit =
    if FileSystems.getDefault.supportedFileAttributeViews.contains("posix") then
      Files.setPosixFilePermissions(file, PosixFilePermissions.fromString("rw-------")): Unit

  /** Runs `keytool`; the password is in the environment, where other users cannot see it. */
  private def keytool(secret: String, store: Path, words: Seq[String]): Either[String, Unit] =
    val program = Path.of(sys.props("java.home"), "bin", "keytool").toString
    val command = (program +: Brief) ++ words ++ Seq(
      "-storetype",
      "PKCS12",
      "-keystore",
      store.toString,
      "-storepass:env",
      "SKEIN_STORE"
    )
    try
      val builder = ProcessBuilder(command*).redirectErrorStream(true)
      builder.environment.put("SKEIN_STORE", secret)
      val process = builder.start()
      process.getOutputStream.close()
      val said = String(process.getInputStream.readAllBytes(), "UTF-8").trim
      Either.cond(process.waitFor() == 0, (), s"keytool ${words.head}: $said")
    catch case NonFatal(failed) => Left(s"cannot run $program: ${failed.getMessage}")
