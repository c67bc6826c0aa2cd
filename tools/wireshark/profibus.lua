-- SPDX-License-Identifier: Apache-2.0
-- Wireshark dissector for PROFIBUS FDL and DP-V0 telegrams, SD to ED, of link types 147 (USER0) and 257 (PROFIBUS_DL).
--
-- Use: wireshark -X lua_script:profibus.lua -r capture.pcapng
-- Names format, addresses, function code, service, SAPs, diagnosis, parameters and the state that the DP slave is in as
-- far as the telegrams show it. Not dissected: the services of DP-V1 (MS1, MS2), of which only the SAP is named.

local proto = Proto("profibus_dp", "PROFIBUS DP")

local formats = {[0x10] = "SD1", [0x68] = "SD2", [0xA2] = "SD3", [0xDC] = "SD4", [0xE5] = "SC"}
local requests = {[0] = "Time_Event", [3] = "SDA low", [4] = "SDN low", [5] = "SDA high", [6] = "SDN high", [7] = "MSRD",
                  [9] = "FDL_Status", [12] = "SRD low", [13] = "SRD high", [14] = "Ident", [15] = "LSAP status"}
local responses = {[0] = "OK", [1] = "UE", [2] = "RR", [3] = "RS", [8] = "DL", [9] = "NR", [10] = "DH", [12] = "RDL", [13] = "RDH"}
local services = {[49] = "MS2 Resource_Manager", [50] = "MS1 Alarm_Ack", [51] = "MS1", [53] = "Set_Ext_Prm", [55] = "Set_Slave_Add",
                  [56] = "RD_Input", [57] = "RD_Output", [58] = "Global_Control", [59] = "Get_Cfg", [60] = "Slave_Diag",
                  [61] = "Set_Prm", [62] = "Chk_Cfg"}
local stations = {[0] = "slave", [1] = "master not ready", [2] = "master ready", [3] = "master in ring"}

local f = {
    format = ProtoField.string("profibus_dp.format", "Format"),
    le = ProtoField.uint8("profibus_dp.le", "LE"),
    da = ProtoField.uint8("profibus_dp.da", "DA", base.DEC, nil, 0x7F),
    sa = ProtoField.uint8("profibus_dp.sa", "SA", base.DEC, nil, 0x7F),
    fc = ProtoField.uint8("profibus_dp.fc", "FC", base.HEX),
    request = ProtoField.uint8("profibus_dp.fc.request", "Request", base.DEC, nil, 0x40),
    fcb = ProtoField.uint8("profibus_dp.fc.fcb", "FCB", base.DEC, nil, 0x20),
    fcv = ProtoField.uint8("profibus_dp.fc.fcv", "FCV", base.DEC, nil, 0x10),
    station_type = ProtoField.uint8("profibus_dp.fc.station_type", "Station type", base.DEC, stations, 0x30),
    func = ProtoField.string("profibus_dp.function", "Function"),
    dsap = ProtoField.uint8("profibus_dp.dsap", "DSAP"),
    ssap = ProtoField.uint8("profibus_dp.ssap", "SSAP"),
    service = ProtoField.string("profibus_dp.service", "Service"),
    state = ProtoField.string("profibus_dp.state", "DP_State"),
    data = ProtoField.bytes("profibus_dp.data", "Data"),
    fcs = ProtoField.uint8("profibus_dp.fcs", "FCS", base.HEX),
    reject = ProtoField.string("profibus_dp.reject", "Rejected"),
    master = ProtoField.uint8("profibus_dp.diag.master_add", "Diag_Master_Add"),
    ident = ProtoField.uint16("profibus_dp.ident", "Ident_Number", base.HEX),
    ext_diag_data = ProtoField.bytes("profibus_dp.diag.ext_diag_data", "Ext_Diag_Data"),
    watchdog = ProtoField.uint32("profibus_dp.prm.wd_ms", "T_WD (ms)"),
    min_tsdr = ProtoField.uint8("profibus_dp.prm.min_tsdr", "minTSDR (tBit)"),
    group_ident = ProtoField.uint8("profibus_dp.prm.group_ident", "Group_Ident", base.HEX),
    user_prm = ProtoField.bytes("profibus_dp.prm.user", "User_Prm_Data"),
    group_select = ProtoField.uint8("profibus_dp.gc.group_select", "Group_Select", base.HEX),
    new_address = ProtoField.uint8("profibus_dp.ssa.address", "New_Slave_Address"),
}

-- Bits: field, octet of the data, mask, name. Made from one table each, so that filters and words agree.
local function bits(prefix, rows)
    local list = {}
    for _, row in ipairs(rows) do
        local octet, mask, name = row[1], row[2], row[3]
        local abbreviation = "profibus_dp." .. prefix .. "." .. name:lower()
        local field = ProtoField.bool(abbreviation, name, 8, nil, mask)
        f[abbreviation] = field
        list[#list + 1] = {field = field, octet = octet, mask = mask, name = name}
    end
    return list
end

local diag_bits = bits("diag", {
    {0, 0x01, "Station_Non_Existent"}, {0, 0x02, "Station_Not_Ready"}, {0, 0x04, "Cfg_Fault"}, {0, 0x08, "Ext_Diag"},
    {0, 0x10, "Not_Supported"}, {0, 0x20, "Invalid_Slave_Response"}, {0, 0x40, "Prm_Fault"}, {0, 0x80, "Master_Lock"},
    {1, 0x01, "Prm_Req"}, {1, 0x02, "Stat_Diag"}, {1, 0x08, "WD_On"}, {1, 0x10, "Freeze_Mode"}, {1, 0x20, "Sync_Mode"},
    {1, 0x80, "Deactivated"}, {2, 0x80, "Ext_Diag_Overflow"}})
local prm_bits = bits("prm", {
    {0, 0x80, "Lock_Req"}, {0, 0x40, "Unlock_Req"}, {0, 0x20, "Sync_Req"}, {0, 0x10, "Freeze_Req"}, {0, 0x08, "WD_On"}})
local gc_bits = bits("gc", {
    {0, 0x20, "Sync"}, {0, 0x10, "Unsync"}, {0, 0x08, "Freeze"}, {0, 0x04, "Unfreeze"}, {0, 0x02, "Clear_Data"}})

local list = {}
for _, field in pairs(f) do list[#list + 1] = field end
proto.fields = list

-- What a telegram means depends on those before it; Wireshark dissects in order once, then at random.
local pending, states, known = nil, {}, {}
function proto.init() pending, states, known = nil, {}, {} end

local function set_bits(tree, range, rows)
    local names = {}
    for _, row in ipairs(rows) do
        if range:len() > row.octet then
            local octet = range(row.octet, 1)
            tree:add(row.field, octet)
            if bit.band(octet:uint(), row.mask) ~= 0 then names[#names + 1] = row.name end
        end
    end
    return names
end

local function sum(range)
    local total = 0
    for i = 0, range:len() - 1 do total = total + range(i, 1):uint() end
    return total % 256
end

-- Head, body (DA .. last data octet) and size of the telegram, or the reason why it is none.
local function frame(buffer)
    local length, sd = buffer:len(), buffer(0, 1):uint()
    local size, head = 0, 1
    if sd == 0xE5 then size = 1
    elseif sd == 0xDC then size = 3
    elseif sd == 0x10 then size = 6
    elseif sd == 0xA2 then size = 14
    elseif sd == 0x68 then
        if length < 4 then return nil, "incomplete" end
        local le = buffer(1, 1):uint()
        if le < 4 or le > 249 then return nil, "LE outside 4..249" end
        if le ~= buffer(2, 1):uint() then return nil, "LE and LEr differ" end
        if buffer(3, 1):uint() ~= 0x68 then return nil, "second start delimiter missing" end
        size, head = le + 6, 4
    else return nil, "no start delimiter" end
    if length < size then return nil, "incomplete" end
    if length > size then return nil, "octets behind the telegram" end
    if sd == 0xE5 or sd == 0xDC then return {size = size} end
    local body = buffer(head, size - head - 2)
    if sum(body) ~= buffer(size - 2, 1):uint() then return nil, "wrong FCS" end
    if buffer(size - 1, 1):uint() ~= 0x16 then return nil, "wrong ED" end
    return {size = size, body = body, head = head}
end

local function hex(range)
    local text = range:bytes():tohex(false, " ")
    return #text > 95 and text:sub(1, 95) .. "..." or text
end

local function dissect_diag(tree, data)
    if data:len() < 6 then return "fewer than 6 octets" end
    local names = set_bits(tree, data, diag_bits)
    tree:add(f.master, data(3, 1))
    tree:add(f.ident, data(4, 2))
    if data:len() > 6 then tree:add(f.ext_diag_data, data(6)) end
    local master = data(3, 1):uint()
    names[#names + 1] = master == 255 and "no master" or "master " .. master
    return table.concat(names, ", ") .. string.format(", ident %04XH", data(4, 2):uint())
end

local function dissect_set_prm(tree, data)
    if data:len() < 7 then return "fewer than 7 octets" end
    local names = set_bits(tree, data, prm_bits)
    local base_ms = data:len() > 7 and bit.band(data(7, 1):uint(), 0x04) ~= 0 and 1 or 10
    local wd = data(1, 1):uint() * data(2, 1):uint() * base_ms
    tree:add(f.watchdog, data(1, 2), wd)
    tree:add(f.min_tsdr, data(3, 1))
    tree:add(f.ident, data(4, 2))
    tree:add(f.group_ident, data(6, 1))
    if data:len() > 7 then tree:add(f.user_prm, data(7)) end
    if bit.band(data(0, 1):uint(), 0x08) ~= 0 then names[#names + 1] = "WD " .. wd .. " ms" end
    return table.concat(names, ", ") .. string.format(", ident %04XH", data(4, 2):uint())
end

local function dissect_global_control(tree, data)
    if data:len() ~= 2 then return "not 2 octets" end
    local names = set_bits(tree, data, gc_bits)
    tree:add(f.group_select, data(1, 1))
    return #names == 0 and "Operate" or table.concat(names, ", ")
end

local function dissect_set_slave_add(tree, data)
    if data:len() < 4 then return "fewer than 4 octets" end
    tree:add(f.new_address, data(0, 1))
    tree:add(f.ident, data(1, 2))
    return "new address " .. data(0, 1):uint()
end

local request_data = {Set_Prm = dissect_set_prm, Global_Control = dissect_global_control, Set_Slave_Add = dissect_set_slave_add}
local answer_data = {Slave_Diag = dissect_diag}

-- The state of a slave as its answers show it: a good diagnosis, an acknowledged Set_Prm, data or a refusal.
local function follow(slave, service, answer, data)
    if answer == "RS" and service == "Data_Exchange" then states[slave] = "WAIT-PRM"
    elseif service == "Slave_Diag" and data and data:len() >= 6 then
        local one, two = data(0, 1):uint(), data(1, 1):uint()
        if bit.band(two, 0x01) ~= 0 then states[slave] = "WAIT-PRM"
        elseif bit.band(one, 0x02) ~= 0 then states[slave] = "WAIT-CFG"
        else states[slave] = "DATA-EXCH" end
    elseif service == "Data_Exchange" and (answer == "DL" or answer == "DH" or answer == "SC") then states[slave] = "DATA-EXCH" end
end

local function answered(pinfo, service, slave, answer, data)
    if not pinfo.visited then
        follow(slave, service, answer, data)
        known[pinfo.number] = {service = service, slave = slave, state = states[slave]}
        pending = nil
    end
    return known[pinfo.number] or {}
end

local function show_state(tree, slave_state)
    if slave_state then tree:add(f.state, slave_state):set_generated() end
end

local function dissect_sc(pinfo, tree)
    local context = known[pinfo.number]
    if not pinfo.visited and pending then context = answered(pinfo, pending.service, pending.da, "SC", nil) end
    context = context or {}
    if context.service then
        tree:add(f.service, context.service):set_generated()
        pinfo.cols.src = tostring(context.slave)
    end
    show_state(tree, context.state)
    return "SC" .. (context.service and " " .. context.service .. " acknowledged" or "")
end

local function add_function(tree, octet)
    local fc = octet:uint()
    local branch = tree:add(f.fc, octet)
    branch:add(f.request, octet)
    local is_request = bit.band(fc, 0x40) ~= 0
    if is_request then
        branch:add(f.fcb, octet)
        branch:add(f.fcv, octet)
    else branch:add(f.station_type, octet) end
    local code = bit.band(fc, 0x0F)
    local words = fc == 0xC0 and "Clock_Value" or (is_request and requests or responses)[code] or ("reserved " .. code)
    tree:add(f.func, octet, words)
    return is_request or fc == 0xC0, words
end

local function service_of(sap, words, has_request_data)
    if sap then return services[sap] or (sap <= 48 and "MS2" or "SAP " .. sap) end
    if has_request_data then return "Data_Exchange" end
    return words == "FDL_Status" and "FDL_Status" or nil
end

-- DSAP and SSAP, and what stands behind them.
local function add_saps(tree, unit, da, sa)
    local at, dsap, ssap = 0, nil, nil
    local needed = (da >= 0x80 and 1 or 0) + (sa >= 0x80 and 1 or 0)
    if needed > (unit and unit:len() or 0) then return nil, nil, nil, true end
    if da >= 0x80 then dsap = unit(at, 1):uint(); tree:add(f.dsap, unit(at, 1)); at = at + 1 end
    if sa >= 0x80 then ssap = unit(at, 1):uint(); tree:add(f.ssap, unit(at, 1)); at = at + 1 end
    local data = unit and unit:len() > at and unit(at) or nil
    if data then tree:add(f.data, data) end
    return dsap, ssap, data, false
end

local function dissect_request(pinfo, tree, words, da, sa, dsap, data)
    local service = service_of(dsap, words, words:sub(1, 3) == "SRD" or words == "MSRD")
    if service then tree:add(f.service, service) end
    if not pinfo.visited then
        local unanswered = words:sub(1, 3) == "SDN" or da == 127 or words == "Time_Event" or words == "Clock_Value"
        pending = not unanswered and {da = da, sa = sa, service = service} or nil
    end
    local detail = data and (request_data[service] and request_data[service](tree, data) or hex(data)) or ""
    return words .. (service and service ~= words and " " .. service or "") .. (detail ~= "" and " " .. detail or "")
end

local function dissect_answer(pinfo, tree, words, da, sa, ssap, data)
    local matches = pending and pending.da == sa and (pending.sa == da or da == 127)
    local service = ssap and service_of(ssap, words, false) or matches and pending.service or data and "Data_Exchange" or nil
    local context = answered(pinfo, service, sa, words, data)
    service = context.service
    if service then tree:add(f.service, service) end
    show_state(tree, context.state)
    local detail = data and (answer_data[service] and answer_data[service](tree, data) or hex(data)) or ""
    return words .. (service and " " .. service or "") .. (detail ~= "" and " " .. detail or "")
end

local function dissect_telegram(pinfo, tree, telegram)
    local body = telegram.body
    local da, sa = body(0, 1):uint(), body(1, 1):uint()
    tree:add(f.da, body(0, 1))
    tree:add(f.sa, body(1, 1))
    pinfo.cols.dst, pinfo.cols.src = tostring(da % 128), tostring(sa % 128)
    local is_request, words = add_function(tree, body(2, 1))
    local dsap, ssap, data, short = add_saps(tree, body:len() > 3 and body(3) or nil, da, sa)
    if short then
        tree:add(f.reject, "no room for the SAP octets")
        return words .. " without room for its SAP octets"
    end
    if is_request then return dissect_request(pinfo, tree, words, da % 128, sa % 128, dsap, data) end
    return dissect_answer(pinfo, tree, words, da % 128, sa % 128, ssap, data)
end

function proto.dissector(buffer, pinfo, root)
    if buffer:len() == 0 then return 0 end
    pinfo.cols.protocol = "PROFIBUS"
    local tree = root:add(proto, buffer())
    local telegram, reason = frame(buffer)
    if not telegram then
        tree:add(f.reject, reason)
        tree:add_expert_info(PI_MALFORMED, PI_ERROR, "rejected: " .. reason)
        pinfo.cols.info = "rejected: " .. reason
        return buffer:len()
    end
    local sd = buffer(0, 1):uint()
    tree:add(f.format, buffer(0, 1), formats[sd])
    local info = ""
    if sd == 0xE5 then info = dissect_sc(pinfo, tree)
    elseif sd == 0xDC then
        tree:add(f.da, buffer(1, 1))
        tree:add(f.sa, buffer(2, 1))
        pinfo.cols.dst, pinfo.cols.src = tostring(buffer(1, 1):uint() % 128), tostring(buffer(2, 1):uint() % 128)
        if not pinfo.visited then pending = nil end
        info = "token"
    else
        if sd == 0x68 then tree:add(f.le, buffer(1, 1)) end
        info = dissect_telegram(pinfo, tree, telegram)
        tree:add(f.fcs, buffer(telegram.size - 2, 1))
    end
    tree:append_text(", " .. info)
    pinfo.cols.info = info
    return buffer:len()
end

-- Wireshark has no name for link type 257: such packets come as encapsulation 0, "unknown".
local encapsulations = DissectorTable.get("wtap_encap")
for _, encapsulation in ipairs({wtap.USER0, wtap.UNKNOWN or 0}) do encapsulations:add(encapsulation, proto) end
