from __future__ import annotations

import pytest
from lxml import etree
from tests.conform.downgrade.conftest import NS14, NS15, Downgrade, document

from colladaphy.conform.downgrade import rules

N = {"c": NS14, "k": NS15}
KEPT = "c:extra/c:technique[@profile='colladaphy-1.5']"


def images(content: str) -> str:
    return document(f"<library_images>{content}</library_images>")


@pytest.mark.parametrize(
    ("content", "expected", "found"),
    [
        ("<init_from><ref>a.png</ref></init_from>", ("init_from", "a.png", {}), 0),
        (
            "<init_from><hex format='png'>00ff</hex></init_from>",
            ("data", "00ff", {"format": "png"}),
            0,
        ),
        (
            "<init_from mips_generate='false'><ref>a</ref></init_from>",
            ("init_from", "a", {}),
            1,
        ),
        (
            "<create_2d><size_exact width='4' height='2'/><mips levels='2' auto_generate='false'/>"
            "<init_from mip_index='1'><ref>small</ref></init_from>"
            "<init_from mip_index='0'><ref>big</ref></init_from></create_2d>",
            ("init_from", "big", {"width": "4", "height": "2"}),
            1,
        ),
        (
            "<create_3d><size width='4' height='2' depth='2'/>"
            "<mips levels='2' auto_generate='false'/></create_3d>",
            ("init_from", None, {}),
            1,
        ),
        ("", ("init_from", None, {}), 1),
        ("<renderable share='true'/>", ("init_from", None, {}), 2),
    ],
)
def test_images(
    downgrade: Downgrade, content: str, expected: tuple[str, str, dict[str, str]], found: int
) -> None:
    new, findings = downgrade(images(f"<image id='i'>{content}</image>"))
    image = new.getroot().find(".//c:image", N)
    assert image is not None
    name, text, attributes = expected
    assert image[0].tag == f"{{{NS14}}}{name}"
    assert image[0].text == text
    assert dict(image.attrib) == {"id": "i", **attributes}
    assert len(findings) == found


def effect(profile: str, before: str = "") -> str:
    return document(f"<library_effects><effect id='e'>{before}{profile}</effect></library_effects>")


def common(params: str, shading: str = "<constant/>") -> str:
    return effect(
        f"<profile_COMMON>{params}<technique sid='t'>{shading}</technique></profile_COMMON>"
    )


def textured(setparam: str, kind: str = "2D") -> str:
    sampler = f"<newparam sid='s'><sampler{kind}/></newparam>"
    return document(
        "<library_effects><effect id='e'><newparam sid='s-surface'><float>1</float></newparam>"
        f"{sampler}<profile_COMMON><technique sid='t'><constant/></technique></profile_COMMON>"
        "</effect></library_effects><library_materials><material><instance_effect url='#e'>"
        f"<setparam ref='s'>{setparam}</setparam></instance_effect></material></library_materials>"
    )


@pytest.mark.parametrize("kind", ["1D", "2D", "3D", "CUBE", "RECT", "DEPTH"])
def test_the_image_of_a_sampler_becomes_that_of_its_surface(
    downgrade: Downgrade, kind: str
) -> None:
    new, findings = downgrade(textured("<sampler_image url='#i'/>", kind))
    root = new.getroot()
    assert root.xpath("//c:newparam/@sid", namespaces=N) == ["s-surface", "s-surface-2", "s"]
    assert root.findtext(f".//c:sampler{kind}/c:source", None, N) == "s-surface-2"
    declared = root.find(".//c:newparam/c:surface", N)
    assert declared is not None
    assert declared.get("type") == kind
    setparam = root.find(".//c:setparam[@ref='s-surface-2']", N)
    assert setparam is not None
    assert setparam.xpath("string(.//@ref)") or setparam.findtext(".//c:init_from", "", N) == "i"
    assert findings == []


def test_samplers_of_profile_common(downgrade: Downgrade) -> None:
    new, findings = downgrade(common("<newparam sid='s'><sampler2D/></newparam>"))
    assert new.getroot().xpath("//c:newparam/@sid", namespaces=N) == ["s-surface", "s"]
    assert findings == []


def test_what_an_upgrade_set_aside_of_a_sampler_comes_back(downgrade: Downgrade) -> None:
    aside = (
        "<extra><technique profile='colladaphy-1.4'><newparam sid='s'><sampler2D>"
        "<instance_image url='#i'/><source>old</source><wrap_s>MIRROR</wrap_s>"
        "<minfilter>LINEAR_MIPMAP_LINEAR</minfilter><magfilter>nonsense</magfilter></sampler2D>"
        "</newparam></technique></extra>"
    )
    text = common("<newparam sid='s'><sampler2D/></newparam>")
    new, _ = downgrade(text.replace("</profile_COMMON>", aside + "</profile_COMMON>"))
    root = new.getroot()
    assert root.findtext(".//c:profile_COMMON/c:newparam/c:surface/c:init_from", "", N) == "i"
    sampler = root.find(".//c:profile_COMMON/c:newparam/c:sampler2D", N)
    assert sampler is not None
    assert [c.text for c in sampler] == [
        "s-surface",
        "MIRROR",
        "LINEAR_MIPMAP_LINEAR",
        "LINEAR",
        "LINEAR",
    ]


@pytest.mark.parametrize("url", ["#other", "other.dae#i", "#1"])
def test_an_image_that_cannot_be_set_is_kept(downgrade: Downgrade, url: str) -> None:
    text = textured(f"<sampler_image url='{url}'/>")
    if url == "#other":
        text = textured("<sampler_image url='#i'/>").replace("url='#e'", "url='#other'")
    new, findings = downgrade(text)
    assert new.getroot().find(f".//c:instance_effect/{KEPT}/k:setparam[@ref='s']", N) is not None
    assert [f.code for f in findings] == [rules.ELEMENT_KEPT.code]


def test_the_states_of_a_sampler(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        textured(
            "<sampler_states><wrap_s>CLAMP</wrap_s><minfilter>NEAREST</minfilter><mipfilter/>"
            "<border_color>0 0 0 1</border_color><mip_max_level>3</mip_max_level>"
            "<mip_bias>0.5</mip_bias><extra><technique profile='x'/></extra></sampler_states>"
        )
    )
    sampler = new.getroot().find(".//c:setparam[@ref='s']/c:sampler2D", N)
    assert sampler is not None
    assert [(etree.QName(c).localname, c.text) for c in sampler] == [
        ("source", "s-surface-2"),
        ("wrap_s", "CLAMP"),
        ("minfilter", "NEAREST"),
        ("magfilter", "LINEAR"),
        ("mipfilter", "LINEAR"),
        ("border_color", "0 0 0 1"),
        ("mipmap_maxlevel", "3"),
        ("mipmap_bias", "0.5"),
        ("extra", None),
    ]
    assert findings == []


@pytest.mark.parametrize("kind", ["1D", "2D", "3D", "CUBE", "RECT", "DEPTH"])
def test_states_that_1_4_does_not_have_are_kept(downgrade: Downgrade, kind: str) -> None:
    new, findings = downgrade(
        textured(
            "<sampler_states><wrap_s>MIRROR_ONCE</wrap_s><wrap_t/><wrap_p/>"
            "<minfilter>ANISOTROPIC</minfilter><magfilter/><mipfilter/>"
            "<border_color>0 0 0 0</border_color><mip_max_level/><mip_min_level/><mip_bias/>"
            "<max_anisotropy/></sampler_states>",
            kind,
        )
    )
    root = new.getroot()
    assert root.findtext(".//c:setparam//c:wrap_s", None, N) == "MIRROR"
    assert root.findtext(".//c:setparam//c:minfilter", None, N) == "LINEAR"
    kept = root.find(f".//c:instance_effect/{KEPT}/k:setparam/k:sampler_states", N)
    assert kept is not None
    assert len(kept) == 11
    assert [f.code for f in findings] == [rules.SAMPLER_CHANGED.code]


def test_shader_profiles_are_kept_and_an_empty_common_one_takes_their_place(
    downgrade: Downgrade,
) -> None:
    new, findings = downgrade(
        effect(
            "<profile_GLSL><technique sid='t'><pass/></technique></profile_GLSL>"
            "<profile_BRIDGE platform='P' url='u'/>",
            "<newparam sid='f'><float2x3>1 2 3 4 5 6</float2x3></newparam>",
        )
    )
    made = new.getroot().find(".//c:effect", N)
    assert made is not None
    assert [etree.QName(c).localname for c in made] == ["newparam", "profile_COMMON", "extra"]
    assert len(made.findall(f"{KEPT}/*", N)) == 2
    assert [f.code for f in findings] == [rules.PROFILE_KEPT.code] * 2 + [rules.EMPTY_PROFILE.code]


def test_parameters_that_an_instance_sets(downgrade: Downgrade) -> None:
    new, findings = downgrade(
        document(
            "<library_materials><material><instance_effect url='#e'>"
            "<setparam ref='a'><float4x1>1 2 3 4</float4x1></setparam>"
            "<setparam ref='b'><sampler_image url='#i'/></setparam>"
            "</instance_effect></material></library_materials>"
        )
    )
    instance = new.getroot().find(".//c:instance_effect", N)
    assert instance is not None
    assert len(instance.findall("c:setparam", N)) == 1
    assert instance.find(f"{KEPT}/k:setparam[@ref='b']", N) is not None
    assert [f.code for f in findings] == [rules.ELEMENT_KEPT.code]


def blend(mode: str, color: list[float], transparency: float) -> list[float]:
    """How much of the background shows, by channel (COLLADA 1.5 §transparent)."""
    share = {
        "A_ONE": [1 - color[3] * transparency] * 3,
        "A_ZERO": [color[3] * transparency] * 3,
        "RGB_ZERO": [c * transparency for c in color[:3]],
        "RGB_ONE": [1 - c * transparency for c in color[:3]],
    }
    return share[mode]


@pytest.mark.parametrize(
    ("mode", "color"),
    [("A_ZERO", [0.1, 0.2, 0.3, 0.4]), ("RGB_ONE", [0.5, 0.5, 0.5, 1.0])],
)
def test_opaque_modes_keep_their_result(
    downgrade: Downgrade, mode: str, color: list[float]
) -> None:
    text = " ".join(map(str, color))
    new, findings = downgrade(
        common(
            "",
            f"<lambert><transparent opaque='{mode}'><color sid='x'>{text}</color></transparent>"
            "</lambert>",
        )
    )
    made = new.getroot().find(".//c:transparent", N)
    assert made is not None
    new_color = [float(part) for part in (made.findtext("c:color", "", N)).split()]
    assert blend(made.get("opaque", ""), new_color, 0.7) == blend(mode, color, 0.7)
    assert [f.code for f in findings] == [rules.OPAQUE_CHANGED.code]


@pytest.mark.parametrize(
    "inner", ["<color>0 1 0 1</color>", "<texture texture='a' texcoord='b'/>", "<param ref='p'/>"]
)
def test_a_transparency_without_an_equal_is_kept(downgrade: Downgrade, inner: str) -> None:
    new, findings = downgrade(
        common("", f"<phong><transparent opaque='RGB_ONE'>{inner}</transparent></phong>")
    )
    assert new.getroot().find(".//c:transparent", N) is None
    assert new.getroot().find(f".//c:technique/{KEPT}//k:transparent", N) is not None
    assert [f.code for f in findings] == [rules.OPAQUE_KEPT.code]


def test_the_extras_of_a_texture_become_one(downgrade: Downgrade) -> None:
    one = "<extra><technique profile='{}'><x/></technique></extra>"
    new, findings = downgrade(
        common(
            "",
            "<lambert><diffuse><texture texture='s' texcoord='u'>"
            + one.format("a")
            + one.format("b")
            + "<extra id='x'><technique profile='c'/></extra></texture></diffuse></lambert>",
        )
    )
    profiles = new.getroot().xpath("//c:texture/c:extra/c:technique/@profile", namespaces=N)
    assert profiles == ["a", "b", "c"]
    assert new.getroot().find(f".//c:technique/{KEPT}//k:extra[@id='x']", N) is not None
    assert len(findings) == 2
