package skein.docs

import java.io.{IOException, StringReader}
import java.nio.file.Files
import java.util.concurrent.TimeUnit
import org.yaml.snakeyaml.Yaml
import scala.jdk.CollectionConverters.*

/** The files in `deploy` agree with each other, and are accepted by the programs that will read them, where
  * these are installed.
  */
class DeploymentSuite extends munit.FunSuite:
  private val root      = Documentation.root
  private val manifests = root.resolve("cluster/deploy/kubernetes")

  /** A document's values by their paths; list elements have their index as a name. */
  private def paths(of: Any, at: String = ""): Map[String, String] = of match
    case map: java.util.Map[?, ?] => map.asScala.flatMap((key, value) => paths(value, s"$at/$key")).toMap
    case list: java.util.List[?]  =>
      list.asScala.zipWithIndex.flatMap((value, place) => paths(value, s"$at/$place")).toMap
    case value => Map(at -> String.valueOf(value))

  private def documents(text: String): Vector[Map[String, String]] =
    Yaml().loadAll(StringReader(text)).asScala.map(paths(_)).toVector

  private def in(file: String) = documents(Files.readString(manifests.resolve(file)))

  private lazy val all = in("namespace.yaml") ++ in("coordinator.yaml") ++ in("workers.yaml")

  private def of(kind: String): Vector[Map[String, String]] = all.filter(_("/kind") == kind)

  /** The values below a path. */
  private def below(document: Map[String, String], path: String): Set[String] =
    document.collect { case (at, value) if at.startsWith(path) => value }.toSet

  /** A program's output, or the reason why it is not run. */
  private def said(words: String*): Either[String, (Int, String)] =
    try
      val process = ProcessBuilder(words*).directory(root.toFile).redirectErrorStream(true).start()
      val text    = String(process.getInputStream.readAllBytes())
      if process.waitFor(60, TimeUnit.SECONDS) then Right((process.exitValue, text)) else Left("it hangs")
    catch case absent: IOException => Left(absent.getMessage)

  test("every manifest is in the kustomization, with a kind, a version and a name"):
    val listed  = below(in("kustomization.yaml").head, "/resources")
    val present = Files.list(manifests).toList.asScala.map(_.getFileName.toString).toSet
    assertEquals(listed, present - "kustomization.yaml")
    for document <- all; key <- Seq("/kind", "/apiVersion", "/metadata/name") do
      assert(document.contains(key), s"$key of $document")

  test("services select existing pods, with the ports and names in the commands"):
    val space       = in("kustomization.yaml").head("/namespace")
    val Vector(job) = of("Job")
    val Vector(set) = of("StatefulSet")
    for (pods, service) <- Seq(job -> job("/spec/template/spec/subdomain"), set -> set("/spec/serviceName"))
    do
      val Some(found) = of("Service").find(_("/metadata/name") == service): @unchecked
      assertEquals(found("/spec/selector/app"), pods("/spec/template/metadata/labels/app"))
      val port = found("/spec/ports/0/port")
      assert(
        pods.exists((at, value) => at.endsWith("/containerPort") && value == port),
        s"$service, port $port"
      )
      val args = below(pods, "/spec/template/spec/containers/0/args").mkString("\n")
      assert(clue(args).contains(s".$service.$space.svc.cluster.local:$port"))
    val coordinator =
      s"${job("/spec/template/spec/hostname")}.${job("/spec/template/spec/subdomain")}.$space.svc.cluster.local"
    assert(below(set, "/spec/template").exists(_.contains(s"--join=$coordinator:")))

  test("mounted volumes exist, and the guide creates the secrets and names the hosts"):
    val guide = Files.readString(root.resolve("docs/guides/cluster.md"))
    for pods <- of("Job") ++ of("StatefulSet") do
      def names(of: String) =
        pods.collect { case (at, value) if at.matches(s"/spec/template/spec/$of/\\d+/name") => value }.toSet
      assertEquals(names("containers/0/volumeMounts"), names("volumes"))
      for case (at, secret) <- pods if at.endsWith("/secretName") do
        assert(guide.contains(s"create secret generic $secret "), secret)
    for host <- Seq("coordinator.search.skein.svc.cluster.local", "*.worker.skein.svc.cluster.local") do
      assert(guide.contains(host), host)

  test("kubectl accepts the combined manifests"):
    val rendered = said("kubectl", "kustomize", manifests.toString)
    assume(rendered.isRight, s"kubectl is not here: ${rendered.left.getOrElse("")}")
    val Right((status, text)) = rendered: @unchecked
    assertEquals(status, 0, text)
    assertEquals(documents(text).map(_("/kind")).sorted, all.map(_("/kind")).sorted)

  test("docker compose reads its file"):
    val here = said("docker", "compose", "version").filterOrElse(_._1 == 0, "no plugin compose")
    assume(here.isRight, s"docker compose is not here: ${here.left.getOrElse("")}")
    val Right((status, text)) =
      said("docker", "compose", "-f", "cluster/deploy/compose.yaml", "config"): @unchecked
    assertEquals(status, 0, text)

  test("an image is built without the history and local build outputs"):
    val left = Files.readAllLines(root.resolve(".dockerignore")).asScala
    for name <- Seq(".git", "**/target") do assert(left.contains(name), name)

  test("workers in the compose file reach the coordinator's port on its loopback"):
    val Vector(file) = documents(Files.readString(root.resolve("cluster/deploy/compose.yaml")))
    val Some(at)     =
      "--cluster (\\S+)".r.findFirstMatchIn(file("/services/coordinator/command")).map(_.group(1)): @unchecked
    assert(file("/services/worker/command").contains(s"--join $at "))
    assertEquals(file("/services/worker/network_mode"), "service:coordinator")
